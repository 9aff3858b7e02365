//! The two containers of glTF: plain JSON, and GLB (JSON and binary data in chunks).

use super::error::ImportError;

/// The JSON and the binary data of a file.
#[derive(Debug)]
pub(super) struct Chunks<'a> {
    pub(super) json: &'a [u8],
    /// The binary chunk of a GLB file.
    pub(super) bin: Option<&'a [u8]>,
}

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Splits a file into its JSON and its binary data.
///
/// # Errors
/// The file is neither glTF JSON nor a complete GLB of version 2.
pub(super) fn split(bytes: &[u8]) -> Result<Chunks<'_>, ImportError> {
    if bytes.starts_with(MAGIC) {
        return split_glb(bytes);
    }
    let start = bytes.iter().find(|byte| !byte.is_ascii_whitespace());
    match start {
        Some(b'{') => Ok(Chunks { json: bytes, bin: None }),
        None => Err(ImportError::new("file", "is empty")),
        Some(_) if bytes.starts_with(b"\xef\xbb\xbf") => {
            Err(ImportError::new("JSON", "starts with a byte order mark, which glTF forbids"))
        }
        Some(_) => {
            Err(ImportError::new("file", "is not glTF: it starts neither with '{' nor with 'glTF' (GLB)"))
        }
    }
}

fn split_glb(bytes: &[u8]) -> Result<Chunks<'_>, ImportError> {
    let header = |offset| {
        read_u32(bytes, offset).ok_or_else(|| ImportError::new("GLB header", "the file ends within it"))
    };
    let (version, length) = (header(4)?, header(8)?);
    if version != 2 {
        return Err(ImportError::new(
            "GLB header",
            format!("version {version} is not supported (allowed: 2)"),
        ));
    }
    let present = bytes.len();
    let body = usize::try_from(length).ok().and_then(|length| bytes.get(12..length)).ok_or_else(|| {
        let reason = format!("the file is truncated: its length is {length} bytes, but it has {present}");
        ImportError::new("GLB header", reason)
    })?;
    let (json, rest) = match chunk(body, "JSON chunk")? {
        Some((JSON, data, rest)) => (data, rest),
        Some(_) => return Err(ImportError::new("GLB", "the first chunk is not JSON")),
        None => return Err(ImportError::new("GLB", "there is no JSON chunk")),
    };
    // glTF says to ignore chunks of other types and chunks after the binary one.
    let bin = match chunk(rest, "second chunk")? {
        Some((BIN, data, _)) => Some(data),
        _ => None,
    };
    Ok(Chunks { json, bin })
}

/// A chunk's type and data, and the bytes after it.
type Chunk<'a> = (u32, &'a [u8], &'a [u8]);

/// Splits off the first chunk; `None` at the end of the file.
fn chunk<'a>(bytes: &'a [u8], name: &str) -> Result<Option<Chunk<'a>>, ImportError> {
    if bytes.is_empty() {
        return Ok(None);
    }
    let (Some(length), Some(kind)) = (read_u32(bytes, 0), read_u32(bytes, 4)) else {
        return Err(ImportError::new(name, "the file ends within its header"));
    };
    let data = bytes.get(8..).unwrap_or_default();
    match usize::try_from(length).ok().and_then(|length| data.split_at_checked(length)) {
        Some((data, rest)) => Ok(Some((kind, data, rest))),
        None => Err(ImportError::new(
            name,
            format!("is truncated: its length is {length} bytes, but only {} follow", data.len()),
        )),
    }
}

fn read_u32(bytes: &[u8], offset: usize) -> Option<u32> {
    let bytes = bytes.get(offset..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*bytes))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn glb(length: u32, chunks: &[(&[u8; 4], u32, &[u8])]) -> Vec<u8> {
        let mut bytes = [MAGIC, &2u32.to_le_bytes(), &length.to_le_bytes()].concat();
        for (kind, length, data) in chunks {
            bytes.extend([&length.to_le_bytes()[..], &kind[..], data].concat());
        }
        bytes
    }

    #[test]
    fn a_complete_glb_is_split_into_json_and_binary() {
        let bytes = glb(12 + 8 + 4 + 8 + 2, &[(b"JSON", 4, b"{}  "), (b"BIN\0", 2, b"ab")]);
        let chunks = split(&bytes).unwrap();
        assert_eq!((chunks.json, chunks.bin), (&b"{}  "[..], Some(&b"ab"[..])));
    }

    #[test]
    fn every_truncation_of_a_glb_is_an_error() {
        let bytes = glb(12 + 8 + 4 + 8 + 2, &[(b"JSON", 4, b"{}  "), (b"BIN\0", 2, b"ab")]);
        for length in 0..bytes.len() {
            assert!(split(&bytes[..length]).is_err(), "{length} bytes");
        }
    }

    #[test]
    fn wrong_lengths_in_a_glb_are_errors() {
        for length in [0, 4, 11, 12, u32::MAX] {
            assert!(split(&glb(length, &[(b"JSON", 4, b"{}  ")])).is_err(), "{length}");
        }
        let reason = split(&glb(24, &[(b"JSON", u32::MAX, b"{}  ")])).unwrap_err().reason;
        assert!(reason.contains("only 4 follow"), "{reason}");
    }

    #[test]
    fn errors_of_files_that_are_not_gltf_say_so() {
        assert!(split(b"").unwrap_err().reason.contains("empty"));
        assert!(split(b"\x89PNG").unwrap_err().reason.contains("not glTF"));
        assert!(split(b"\xef\xbb\xbf{}").unwrap_err().reason.contains("byte order mark"));
    }
}
