//! URIs in a glTF file: data URIs, and paths relative to the file.

use std::path::PathBuf;

use base64::alphabet;
use base64::engine::{DecodePaddingMode, Engine, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

/// The longest part of a URI that a message quotes, characters.
const MAX_QUOTED: usize = 60;

/// Returns the start of a URI in quotes, for messages.
pub(super) fn quote(uri: &str) -> String {
    let start: String = uri.chars().take(MAX_QUOTED).collect();
    let more = if uri.chars().nth(MAX_QUOTED).is_some() { "…" } else { "" };
    format!("{start:?}{more}")
}

/// Decodes a `data:` URI; `None` if the URI is not one.
///
/// # Errors
/// The message says what is wrong with the data.
pub(super) fn data(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let rest = match uri.get(..5) {
        Some(scheme) if scheme.eq_ignore_ascii_case("data:") => &uri[5..],
        _ => return None,
    };
    let Some((media_type, data)) = rest.split_once(',') else {
        return Some(Err(format!("the data URI {} has no comma", quote(uri))));
    };
    let is_base64 = media_type.to_ascii_lowercase().ends_with(";base64");
    let bytes = if is_base64 { decode_base64(data) } else { decode_percent(data) };
    Some(bytes.ok_or_else(|| format!("the data URI {} is not well-formed", quote(uri))))
}

/// Returns the path of a relative URI, which cannot lead out of the scene's directory.
///
/// # Errors
/// The message says why the URI is rejected: another scheme, an absolute path, `..`, or no path at all.
pub(super) fn relative_path(uri: &str) -> Result<PathBuf, String> {
    let reject = |why: &str| Err(format!("{} is rejected: {why}", quote(uri)));
    let Some(path) = decode_percent(uri).and_then(|bytes| String::from_utf8(bytes).ok()) else {
        return reject("it is not well-formed");
    };
    // Both separators count on every system, so that a file means the same on all of them.
    let is_separator = |c: char| c == '/' || c == '\\';
    let first = path.split(is_separator).next().unwrap_or_default();
    if first.contains(':') {
        return reject("only data URIs and files in the scene's directory are read");
    }
    if path.starts_with(is_separator) {
        return reject("the path is absolute (allowed: a path inside the scene's directory)");
    }
    if path.chars().any(char::is_control) {
        return reject("it has control characters");
    }
    let mut result = PathBuf::new();
    for component in path.split(is_separator).filter(|name| !name.is_empty() && *name != ".") {
        if component == ".." {
            return reject("'..' could leave the scene's directory");
        }
        result.push(component);
    }
    if result.as_os_str().is_empty() {
        return reject("it names no file");
    }
    Ok(result)
}

/// Decodes percent-encoded text; `None` where a `%` is not followed by two hexadecimal digits.
fn decode_percent(text: &str) -> Option<Vec<u8>> {
    let is_escape =
        |rest: &str| rest.as_bytes().get(..2).is_some_and(|digits| digits.iter().all(u8::is_ascii_hexdigit));
    text.split('%').skip(1).all(is_escape).then(|| percent_decode_str(text).collect())
}

/// Decodes base64 of the standard alphabet, with or without padding.
fn decode_base64(text: &str) -> Option<Vec<u8>> {
    let padding = if text.ends_with('=') {
        DecodePaddingMode::RequireCanonical
    } else {
        DecodePaddingMode::RequireNone
    };
    let config =
        GeneralPurposeConfig::new().with_decode_padding_mode(padding).with_decode_allow_trailing_bits(true);
    GeneralPurpose::new(&alphabet::STANDARD, config).decode(text).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn base64_of_every_length_is_decoded() {
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zg", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg==", "foob")]
        {
            assert_eq!(decode_base64(text).unwrap(), bytes.as_bytes(), "{text}");
        }
        for text in ["Z", "Z===", "Zg=", "Zm9v=", "Zm 9v", "====", "Zm=v", "Zm9vY"] {
            assert_eq!(decode_base64(text), None, "{text}");
        }
    }

    #[test]
    fn data_uris_of_any_media_type_are_decoded() {
        assert_eq!(data("data:;base64,Zm9v").unwrap().unwrap(), b"foo");
        assert_eq!(data("DATA:text/plain;charset=utf-8,a%20b").unwrap().unwrap(), b"a b");
        assert!(data("data:application/octet-stream").unwrap().is_err());
        assert!(data("data:;base64,!").unwrap().is_err());
        assert!(data("a.bin").is_none());
    }

    #[test]
    fn paths_inside_the_directory_are_accepted() {
        assert_eq!(relative_path("a%20b/./c.bin").unwrap(), PathBuf::from("a b").join("c.bin"));
        assert_eq!(relative_path("maps\\wood.png").unwrap(), PathBuf::from("maps").join("wood.png"));
        assert_eq!(relative_path("..a/b..").unwrap(), PathBuf::from("..a").join("b.."));
    }

    #[test]
    fn paths_out_of_the_directory_are_rejected() {
        for uri in [
            "../a.bin",
            "a/../../b",
            "a/..",
            "%2e%2e/a",
            "..%2fa",
            "..\\a",
            "/etc/passwd",
            "%2Fetc",
            "\\\\host\\a",
            "http://example.com/a.bin",
            "HTTPS://example.com",
            "file:///a",
            "C:\\a.bin",
            "c:a",
            "a%00b",
            "",
            ".",
            "./",
            "%",
            "%4",
            "%zz",
            "%ff",
        ] {
            assert!(relative_path(uri).is_err(), "{uri}");
        }
    }
}
