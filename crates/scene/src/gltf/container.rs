//! The two forms of a glTF file: plain JSON, and GLB (JSON and binary data in chunks).

use super::fault::{Fault, fault};

/// The parts of a file.
#[derive(Debug)]
pub(super) struct Parts<'a> {
    pub(super) json: &'a [u8],
    /// The binary chunk of a GLB file.
    pub(super) bin: Option<&'a [u8]>,
}

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Finds the parts of a file.
///
/// # Errors
/// Names what is wrong if the file is neither glTF nor a whole GLB of version 2.
pub(super) fn split(bytes: &[u8]) -> Result<Parts<'_>, Fault> {
    if bytes.starts_with(MAGIC) {
        return split_glb(bytes);
    }
    let start = bytes.iter().find(|byte| !byte.is_ascii_whitespace());
    match start {
        Some(b'{') => Ok(Parts { json: bytes, bin: None }),
        None => Err(fault("file", "is empty")),
        Some(_) if bytes.starts_with(b"\xef\xbb\xbf") => {
            Err(fault("JSON", "starts with a byte order mark, which glTF does not allow"))
        }
        Some(_) => Err(fault("file", "is not glTF: it starts neither with '{' nor with 'glTF' (GLB)")),
    }
}

fn split_glb(bytes: &[u8]) -> Result<Parts<'_>, Fault> {
    let header = |offset| word(bytes, offset).ok_or_else(|| fault("GLB header", "the file ends inside it"));
    let (version, length) = (header(4)?, header(8)?);
    if version != 2 {
        return Err(fault("GLB header", format!("version {version} is not supported (allowed: 2)")));
    }
    let present = bytes.len();
    let body = usize::try_from(length).ok().and_then(|length| bytes.get(12..length)).ok_or_else(|| {
        let reason = format!("the file should have {length} bytes and has {present}: it is truncated");
        fault("GLB header", reason)
    })?;
    let (json, rest) = match chunk(body, "JSON chunk")? {
        Some((JSON, data, rest)) => (data, rest),
        Some(_) => return Err(fault("GLB", "the first chunk is not JSON")),
        None => return Err(fault("GLB", "there is no JSON chunk")),
    };
    // Chunks of other kinds and after the binary one are to be ignored.
    let bin = match chunk(rest, "second chunk")? {
        Some((BIN, data, _)) => Some(data),
        _ => None,
    };
    Ok(Parts { json, bin })
}

/// A chunk's kind and data, and what follows it.
type Chunk<'a> = (u32, &'a [u8], &'a [u8]);

/// Splits off a chunk; `None` at the end.
fn chunk<'a>(bytes: &'a [u8], name: &str) -> Result<Option<Chunk<'a>>, Fault> {
    if bytes.is_empty() {
        return Ok(None);
    }
    let (Some(length), Some(kind)) = (word(bytes, 0), word(bytes, 4)) else {
        return Err(fault(name, "the file ends inside its header"));
    };
    let data = bytes.get(8..).unwrap_or_default();
    match usize::try_from(length).ok().and_then(|length| data.split_at_checked(length)) {
        Some((data, rest)) => Ok(Some((kind, data, rest))),
        None => Err(fault(
            name,
            format!("should have {length} bytes, but only {} are there: it is truncated", data.len()),
        )),
    }
}

fn word(bytes: &[u8], offset: usize) -> Option<u32> {
    let word = bytes.get(offset..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*word))
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
    fn a_whole_glb_is_split_into_json_and_binary() {
        let bytes = glb(12 + 8 + 4 + 8 + 2, &[(b"JSON", 4, b"{}  "), (b"BIN\0", 2, b"ab")]);
        let parts = split(&bytes).unwrap();
        assert_eq!((parts.json, parts.bin), (&b"{}  "[..], Some(&b"ab"[..])));
    }

    #[test]
    fn every_truncation_of_a_glb_is_refused() {
        let bytes = glb(12 + 8 + 4 + 8 + 2, &[(b"JSON", 4, b"{}  "), (b"BIN\0", 2, b"ab")]);
        for length in 0..bytes.len() {
            assert!(split(&bytes[..length]).is_err(), "{length} bytes");
        }
    }

    #[test]
    fn wrong_lengths_in_a_glb_are_refused() {
        for length in [0, 4, 11, 12, u32::MAX] {
            assert!(split(&glb(length, &[(b"JSON", 4, b"{}  ")])).is_err(), "{length}");
        }
        let reason = split(&glb(24, &[(b"JSON", u32::MAX, b"{}  ")])).unwrap_err().reason;
        assert!(reason.contains("only 4 are there"), "{reason}");
    }

    #[test]
    fn files_that_are_not_gltf_are_named_so() {
        assert!(split(b"").unwrap_err().reason.contains("empty"));
        assert!(split(b"\x89PNG").unwrap_err().reason.contains("not glTF"));
        assert!(split(b"\xef\xbb\xbf{}").unwrap_err().reason.contains("byte order mark"));
    }
}
