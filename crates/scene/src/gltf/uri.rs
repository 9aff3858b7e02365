//! URIs in a glTF file: data URIs, and paths relative to the file.

use std::path::PathBuf;

/// The longest part of a URI that is shown in a message, characters.
const MAX_SHOWN: usize = 60;

/// Returns the start of a URI in quotes, for messages.
pub(super) fn shown(uri: &str) -> String {
    let start: String = uri.chars().take(MAX_SHOWN).collect();
    let more = if uri.chars().nth(MAX_SHOWN).is_some() { "…" } else { "" };
    format!("{start:?}{more}")
}

/// Decodes a `data:` URI; `None` if the URI is not one.
///
/// # Errors
/// Says what is wrong with the data.
pub(super) fn data(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let rest = match uri.get(..5) {
        Some(scheme) if scheme.eq_ignore_ascii_case("data:") => &uri[5..],
        _ => return None,
    };
    let Some((kind, data)) = rest.split_once(',') else {
        return Some(Err(format!("the data URI {} has no comma", shown(uri))));
    };
    let bytes =
        if kind.to_ascii_lowercase().ends_with(";base64") { base64(data.as_bytes()) } else { percent(data) };
    Some(bytes.ok_or_else(|| format!("the data URI {} is not well-formed", shown(uri))))
}

/// Returns the path of a relative URI, free of anything that could lead out of its folder.
///
/// # Errors
/// Says why the URI is refused: another scheme, an absolute path, `..`, or no path at all.
pub(super) fn relative_path(uri: &str) -> Result<PathBuf, String> {
    let refuse = |why: &str| Err(format!("{} is refused: {why}", shown(uri)));
    let Some(path) = percent(uri).and_then(|bytes| String::from_utf8(bytes).ok()) else {
        return refuse("it is not well-formed");
    };
    // Both separators count on every system, so that a file means the same everywhere.
    let is_separator = |c: char| c == '/' || c == '\\';
    let first = path.split(is_separator).next().unwrap_or_default();
    if first.contains(':') {
        return refuse("only data URIs and files in the scene's own folder are read");
    }
    if path.starts_with(is_separator) {
        return refuse("the path is absolute (allowed: a path inside the scene's own folder)");
    }
    if path.chars().any(char::is_control) {
        return refuse("it has control characters");
    }
    let mut result = PathBuf::new();
    for part in path.split(is_separator).filter(|part| !part.is_empty() && *part != ".") {
        if part == ".." {
            return refuse("'..' could leave the scene's own folder");
        }
        result.push(part);
    }
    if result.as_os_str().is_empty() {
        return refuse("it names no file");
    }
    Ok(result)
}

/// Decodes `%41` to `A`.
fn percent(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let mut digit = || char::from(rest.next()?).to_digit(16);
            let value = digit()? * 16 + digit()?;
            bytes.push(u8::try_from(value).ok()?);
        } else {
            bytes.push(byte);
        }
    }
    Some(bytes)
}

/// Decodes base64 of the standard alphabet, with or without padding.
fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let padding = text.iter().rev().take_while(|byte| **byte == b'=').count();
    let digits = &text[..text.len() - padding];
    if padding > 2 || (padding > 0 && !text.len().is_multiple_of(4)) || digits.len() % 4 == 1 {
        return None;
    }
    let mut bytes = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    for group in digits.chunks(4) {
        let mut bits = 0u32;
        for digit in group {
            bits = bits << 6 | sextet(*digit)?;
        }
        bits <<= 6 * (4 - group.len());
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Some(bytes)
}

fn sextet(digit: u8) -> Option<u32> {
    let value = match digit {
        b'A'..=b'Z' => digit - b'A',
        b'a'..=b'z' => digit - b'a' + 26,
        b'0'..=b'9' => digit - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    };
    Some(u32::from(value))
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
            assert_eq!(base64(text.as_bytes()).unwrap(), bytes.as_bytes(), "{text}");
        }
        for text in ["Z", "Z===", "Zm9v=", "Zm 9v", "====", "Zm=v", "Zm9vY"] {
            assert_eq!(base64(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn data_uris_are_decoded_with_any_kind() {
        assert_eq!(data("data:;base64,Zm9v").unwrap().unwrap(), b"foo");
        assert_eq!(data("DATA:text/plain;charset=utf-8,a%20b").unwrap().unwrap(), b"a b");
        assert!(data("data:application/octet-stream").unwrap().is_err());
        assert!(data("data:;base64,!").unwrap().is_err());
        assert!(data("a.bin").is_none());
    }

    #[test]
    fn paths_inside_the_folder_are_taken() {
        assert_eq!(relative_path("a%20b/./c.bin").unwrap(), PathBuf::from("a b").join("c.bin"));
        assert_eq!(relative_path("maps\\wood.png").unwrap(), PathBuf::from("maps").join("wood.png"));
        assert_eq!(relative_path("..a/b..").unwrap(), PathBuf::from("..a").join("b.."));
    }

    #[test]
    fn paths_out_of_the_folder_are_refused() {
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
