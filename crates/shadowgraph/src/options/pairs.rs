//! `key=value key=value`: the syntax of cameras and suns.

use super::error::OptionError;
use glam::DVec3;
use std::fmt;

/// The range of a key's value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    min: f64,
    max: f64,
    /// Whether `min` itself is excluded.
    exclusive: bool,
    unit: &'static str,
}

impl Range {
    pub(super) const fn within(min: f64, max: f64, unit: &'static str) -> Self {
        Self { min, max, exclusive: false, unit }
    }

    pub(super) const fn above(min: f64, max: f64, unit: &'static str) -> Self {
        Self { min, max, exclusive: true, unit }
    }

    /// Returns whether a value lies in the range; NaN never does.
    pub(super) fn contains(&self, value: f64) -> bool {
        value <= self.max && if self.exclusive { value > self.min } else { value >= self.min }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let start = if self.exclusive { "above " } else { "" };
        write!(
            f,
            "{start}{} to {}{}{}",
            self.min,
            self.max,
            if self.unit.is_empty() { "" } else { " " },
            self.unit
        )
    }
}

/// The keys of one option and their values, as text.
pub(super) struct Pairs<'a> {
    option: &'static str,
    pairs: Vec<(&'a str, &'a str)>,
}

impl<'a> Pairs<'a> {
    /// Splits `text`, and refuses unknown and duplicate keys.
    pub(super) fn parse(option: &'static str, text: &'a str, known: &[&str]) -> Result<Self, OptionError> {
        let mut pairs: Vec<(&str, &str)> = Vec::new();
        for word in text.split_whitespace() {
            let Some((key, value)) = word.split_once('=') else {
                let reason =
                    format!("invalid value `{word}`; expected key=value with the keys {}", known.join(", "));
                return Err(OptionError::new(option, reason));
            };
            if !known.contains(&key) {
                let reason = format!("unknown key `{key}`; expected one of: {}", known.join(", "));
                return Err(OptionError::new(option, reason));
            }
            if pairs.iter().any(|(other, _)| *other == key) {
                return Err(OptionError::new(option, format!("duplicate key `{key}`")));
            }
            pairs.push((key, value));
        }
        Ok(Self { option, pairs })
    }

    /// Returns the error for a missing key.
    pub(super) fn missing(&self, key: &str, form: &str) -> OptionError {
        OptionError::new(self.option, format!("missing key `{key}`; expected {form}"))
    }

    /// Returns a number within a range; `None` if the key is missing.
    pub(super) fn number(&self, key: &str, range: Range) -> Result<Option<f64>, OptionError> {
        let Some(text) = self.get(key) else { return Ok(None) };
        self.one(key, text, text, range).map(Some)
    }

    /// Returns three numbers, each within a range; `None` if the key is missing.
    pub(super) fn vector(&self, key: &str, range: Range) -> Result<Option<DVec3>, OptionError> {
        let Some(text) = self.get(key) else { return Ok(None) };
        let parts: Vec<&str> = text.split(',').collect();
        let [x, y, z] = parts.as_slice() else {
            let reason = format!("invalid value `{key}={text}`; expected three numbers X,Y,Z without spaces");
            return Err(OptionError::new(self.option, reason));
        };
        let one = |part: &str| self.one(key, text, part, range);
        Ok(Some(DVec3::new(one(x)?, one(y)?, one(z)?)))
    }

    /// Returns a time of day, HH:MM or HH:MM:SS from 00:00 to 24:00, in hours; `None` if the key is missing.
    pub(super) fn time(&self, key: &str) -> Result<Option<f64>, OptionError> {
        let Some(text) = self.get(key) else { return Ok(None) };
        let invalid = || {
            let form = "expected HH:MM or HH:MM:SS, from 00:00 to 24:00";
            OptionError::new(self.option, format!("invalid value `{key}={text}`; {form}"))
        };
        let part = |part: &str| {
            let digits = part.len() <= 2 && part.bytes().all(|byte| byte.is_ascii_digit());
            part.parse::<u8>().ok().filter(|_| digits).map(f64::from).ok_or_else(invalid)
        };
        let parts = text.split(':').map(part).collect::<Result<Vec<_>, _>>()?;
        let (hours, minutes, seconds) = match *parts.as_slice() {
            [hours, minutes] => (hours, minutes, 0.0),
            [hours, minutes, seconds] => (hours, minutes, seconds),
            _ => return Err(invalid()),
        };
        let hour = hours + minutes / 60.0 + seconds / 3600.0;
        if minutes < 60.0 && seconds < 60.0 && hour <= 24.0 { Ok(Some(hour)) } else { Err(invalid()) }
    }

    /// Returns the key of these that was given first, if any.
    pub(super) fn any_of(&self, keys: &[&'static str]) -> Option<&'static str> {
        keys.iter().copied().find(|key| self.get(key).is_some())
    }

    fn get(&self, key: &str) -> Option<&'a str> {
        self.pairs.iter().find(|(other, _)| *other == key).map(|(_, value)| *value)
    }

    fn one(&self, key: &str, whole: &str, part: &str, range: Range) -> Result<f64, OptionError> {
        let value: f64 = part.parse().map_err(|_| {
            OptionError::new(
                self.option,
                format!("{key}={whole}: `{part}` is not a number; expected {range}"),
            )
        })?;
        if range.contains(value) {
            return Ok(value);
        }
        Err(OptionError::new(self.option, format!("{key}={whole} is out of range: {range}")))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    const RANGE: Range = Range::above(0.0, 10.0, "m");

    fn error(text: &str) -> String {
        let number = |text| Pairs::parse("o", text, &["a", "b"])?.number("a", RANGE);
        number(text).unwrap_err().to_string()
    }

    #[test]
    fn an_unknown_key_is_named_with_the_known_ones() {
        assert_eq!(error("c=1"), "o: unknown key `c`; expected one of: a, b");
    }

    #[test]
    fn a_duplicate_key_is_refused() {
        assert_eq!(error("a=1 b=2 a=3"), "o: duplicate key `a`");
    }

    #[test]
    fn nan_infinite_and_large_values_are_refused_with_the_range() {
        for text in ["a=NaN", "a=inf", "a=-inf", "a=0", "a=10.5", "a=1e999"] {
            assert!(error(text).ends_with("is out of range: above 0 to 10 m"), "{}", error(text));
        }
        assert_eq!(error("a=ten"), "o: a=ten: `ten` is not a number; expected above 0 to 10 m");
        assert_eq!(error("a="), "o: a=: `` is not a number; expected above 0 to 10 m");
    }

    #[test]
    fn a_time_is_hours_and_minutes_with_optional_seconds() {
        let time = |text: &str| Pairs::parse("o", text, &["a"]).and_then(|pairs| pairs.time("a"));
        for (text, hour) in [("a=15:30", 15.5), ("a=0:00", 0.0), ("a=24:00", 24.0), ("a=06:00:36", 6.01)] {
            assert!((time(text).unwrap().unwrap() - hour).abs() < 1e-12, "{text}");
        }
        assert_eq!(time("").unwrap(), None);
        for text in
            ["a=15", "a=24:01", "a=12:60", "a=12:00:60", "a=-1:00", "a=+1:00", "a=1:2:3:4", "a=:", "a=256:00"]
        {
            let error = time(text).unwrap_err().to_string();
            assert_eq!(
                error,
                format!("o: invalid value `{text}`; expected HH:MM or HH:MM:SS, from 00:00 to 24:00")
            );
        }
    }

    #[test]
    fn a_vector_needs_exactly_three_numbers() {
        let pairs = Pairs::parse("o", "a=1,2 b=1,2,3", &["a", "b"]).unwrap();
        assert!(pairs.vector("a", RANGE).unwrap_err().to_string().contains("expected three numbers"));
        assert_eq!(pairs.vector("b", RANGE).unwrap(), Some(DVec3::new(1.0, 2.0, 3.0)));
    }
}
