//! What culls instances.

use super::error::OptionError;
use crate::culling::Culling;
use std::str::FromStr;

impl FromStr for Culling {
    type Err = OptionError;

    /// ```
    /// use shadowgraph::Culling;
    /// assert_eq!("gpu".parse(), Ok(Culling::Gpu));
    /// let error = "GPU".parse::<Culling>().unwrap_err().to_string();
    /// assert_eq!(error, "culling: invalid value `GPU`; expected auto, cpu, gpu");
    /// ```
    fn from_str(text: &str) -> Result<Self, OptionError> {
        match text {
            "auto" => Ok(Self::Auto),
            "cpu" => Ok(Self::Cpu),
            "gpu" => Ok(Self::Gpu),
            _ => Err(OptionError::new("culling", format!("invalid value `{text}`; expected auto, cpu, gpu"))),
        }
    }
}
