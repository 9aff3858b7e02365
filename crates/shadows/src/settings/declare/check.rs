//! Validation of settings.

use super::DescribeSettings;
use crate::error::Error;
use crate::settings::describe::{Setting, SettingType};

/// A value that [`declare_settings!`](crate::declare_settings) can check.
pub trait SettingValue {
    /// Checks the value of a setting.
    ///
    /// # Errors
    /// [`Error::Setting`] with the setting's name, the value and what is allowed.
    fn check(&self, setting: &Setting) -> Result<(), Error>;

    /// Appends a number or a toggle, four bytes, for a shader; nothing for other types.
    fn write_scalar(&self, _bytes: &mut Vec<u8>) {}
}

impl<T: DescribeSettings> SettingValue for T {
    fn check(&self, setting: &Setting) -> Result<(), Error> {
        self.validate().map_err(|error| error.inside(setting.name))
    }
}

impl SettingValue for bool {
    fn check(&self, _setting: &Setting) -> Result<(), Error> {
        Ok(())
    }

    fn write_scalar(&self, bytes: &mut Vec<u8>) {
        u32::from(*self).write_scalar(bytes);
    }
}

impl SettingValue for u32 {
    fn check(&self, setting: &Setting) -> Result<(), Error> {
        let value = i64::from(*self);
        let fits = match setting.ty {
            SettingType::Integer(_, low, high) => (low..=high).contains(&value),
            SettingType::PowerOfTwo(_, low, high) => self.is_power_of_two() && (low..=high).contains(&value),
            _ => true,
        };
        if fits { Ok(()) } else { Err(Error::invalid(setting, self)) }
    }

    fn write_scalar(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_ne_bytes());
    }
}

impl SettingValue for f32 {
    // In 32 bits, as 0.1 is above 0.1 in 64. NaN is refused.
    fn check(&self, setting: &Setting) -> Result<(), Error> {
        match setting.ty {
            SettingType::Number(_, low, high) if !(low as f32..=high as f32).contains(self) => {
                Err(Error::invalid(setting, self))
            }
            _ => Ok(()),
        }
    }

    fn write_scalar(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_ne_bytes());
    }
}

impl SettingValue for f64 {
    fn check(&self, setting: &Setting) -> Result<(), Error> {
        match setting.ty {
            SettingType::Number(_, low, high) if !(low..=high).contains(self) => {
                Err(Error::invalid(setting, self))
            }
            _ => Ok(()),
        }
    }

    fn write_scalar(&self, bytes: &mut Vec<u8>) {
        (*self as f32).write_scalar(bytes);
    }
}

impl<T: SettingValue> SettingValue for Option<T> {
    fn check(&self, setting: &Setting) -> Result<(), Error> {
        let inner = match setting.ty {
            SettingType::Optional(inner) => *inner,
            other => other,
        };
        self.as_ref().map_or(Ok(()), |value| value.check(&Setting { ty: inner, ..*setting }))
    }
}

impl<T: SettingValue> SettingValue for Vec<T> {
    fn check(&self, setting: &Setting) -> Result<(), Error> {
        let SettingType::List(_, item) = setting.ty else { return Ok(()) };
        for (index, value) in self.iter().enumerate() {
            let checked =
                value.check(&Setting { name: "", ty: *item, unit: setting.unit, note: "", about: "" });
            checked.map_err(|error| match item {
                SettingType::Struct(_) => error.inside(&index.to_string()).inside(setting.name),
                // What is wrong with a number is best said of the list.
                _ => error.allowing(setting.allowed()).inside(setting.name),
            })?;
        }
        Ok(())
    }
}
