//! The command line.

use std::path::PathBuf;

use shadowgraph::options::{AdapterChoice, OptionError, Size};

pub(crate) const HELP: &str = "\
Measures the techniques and the graph on a GPU, and runs the pixel tests on it. Writes gpu-report.json and gpu-report.html.

  gpu-report [OPTIONS]

  --adapter auto|NAME|cpu   the GPU; default: auto
  --city INSTANCES          size of the city; default: 100000, on software drivers 10000 with 4 of its lights
  --size WxH                size of the frames; default: 1280x720, on software drivers 320x180
  --frames N                measured frames of each scene and technique; default: 20, on software drivers 2
  --no-pixel-tests          leave out the pixel tests
  -o DIRECTORY              where the report is written; default: the current directory

Files in the directory `scenes` next to the program are measured in addition to the demo scene and the city.
";

/// The options.
#[derive(Debug, PartialEq)]
pub(crate) struct Arguments {
    /// The adapter, and the text that names it.
    pub(crate) adapter: (AdapterChoice, String),
    pub(crate) city: Option<u32>,
    pub(crate) size_px: Option<[u32; 2]>,
    pub(crate) frames: Option<u32>,
    pub(crate) pixel_tests: bool,
    pub(crate) output: PathBuf,
}

impl Arguments {
    /// Parses the command line; `None` if it asks for help.
    ///
    /// # Errors
    /// One line with the option and its allowed values.
    pub(crate) fn parse(arguments: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let mut parsed = Self {
            adapter: (AdapterChoice::Auto, "auto".to_owned()),
            city: None,
            size_px: None,
            frames: None,
            pixel_tests: true,
            output: PathBuf::from("."),
        };
        let mut arguments = arguments;
        while let Some(option) = arguments.next() {
            if matches!(&*option, "help" | "--help" | "-h") {
                return Ok(None);
            }
            if option == "--no-pixel-tests" {
                parsed.pixel_tests = false;
                continue;
            }
            if !["--adapter", "--city", "--size", "--frames", "-o"].contains(&&*option) {
                return Err(format!("unknown option `{option}`; --help lists the options"));
            }
            let value = arguments.next().ok_or_else(|| format!("{option} needs a value"))?;
            let number = |low, high| {
                let number = value.parse().ok().filter(|number| (low..=high).contains(number));
                number.ok_or_else(|| format!("{option}: invalid value `{value}`; allowed: {low} to {high}"))
            };
            match &*option {
                "--adapter" => {
                    let adapter = value.parse().map_err(|error: OptionError| format!("--{error}"))?;
                    parsed.adapter = (adapter, value);
                }
                "--city" => {
                    let range = shadowgraph_samples::city::CITY_INSTANCES;
                    parsed.city = Some(number(*range.start(), *range.end())?);
                }
                "--size" => {
                    let size: Size = value.parse().map_err(|error: OptionError| format!("--{error}"))?;
                    parsed.size_px = Some([size.width_px, size.height_px]);
                }
                "--frames" => parsed.frames = Some(number(1, 1_000)?),
                _ => parsed.output = PathBuf::from(value),
            }
        }
        Ok(Some(parsed))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    fn parse(line: &str) -> Result<Option<Arguments>, String> {
        Arguments::parse(line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn options_are_read() {
        let parsed =
            parse("--city 20000 --size 64x32 --frames 3 --no-pixel-tests -o there").unwrap().unwrap();
        assert_eq!((parsed.city, parsed.size_px, parsed.frames), (Some(20_000), Some([64, 32]), Some(3)));
        assert_eq!((parsed.pixel_tests, parsed.output), (false, PathBuf::from("there")));
        assert_eq!(parse("--help"), Ok(None));
    }

    #[test]
    fn an_invalid_option_is_an_error_of_one_line() {
        for (line, start) in [
            ("--city 5", "--city: invalid value `5`; allowed: 10000 to 1000000"),
            ("--frames many", "--frames: invalid value `many`; allowed: 1 to 1000"),
            ("--size 0x9", "--size: width 0"),
            ("--city", "--city needs a value"),
            ("--page", "unknown option `--page`"),
        ] {
            let error = parse(line).unwrap_err();
            assert!(error.starts_with(start) && error.lines().count() == 1, "{error}");
        }
    }
}
