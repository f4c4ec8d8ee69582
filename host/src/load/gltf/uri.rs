//! Where a glTF's buffers and images are: in the file itself as `data:`, or in a file beside it.

use std::path::{Path, PathBuf};

/// What a URI means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Uri {
    /// The bytes themselves.
    Data(Vec<u8>),
    /// Files that may be meant, the likeliest first.
    Files([PathBuf; 2]),
}

impl Uri {
    /// Reads a URI; files are looked for in `folder`. An error says what is wrong in one clause.
    pub(super) fn read(text: &str, folder: &Path) -> Result<Self, String> {
        if let Some(rest) = text.strip_prefix("data:") {
            let Some((kind, content)) = rest.split_once(',') else { return Err("is a data: URI without a comma".into()) };
            if !kind.ends_with(";base64") {
                return Err("is a data: URI that is not in base64".into());
            }
            return base64(content.as_bytes()).map(Self::Data).ok_or_else(|| "is a data: URI whose base64 is damaged".into());
        }
        if text.contains("://") {
            return Err(format!("is at {}, and nothing is fetched from elsewhere", shortened(text)));
        }
        if text.is_empty() {
            return Err("has an empty URI".into());
        }
        // Some programs write names as they are, where % is a letter like others.
        Ok(Self::Files([folder.join(unescaped(text)), folder.join(text)]))
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(80).collect()
}

/// With `%20` and the like decoded, where they make UTF-8.
fn unescaped(text: &str) -> String {
    let digit = |c: Option<&u8>| c.and_then(|c| char::from(*c).to_digit(16));
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        match (byte, digit(bytes.get(at + 1)), digit(bytes.get(at + 2))) {
            (b'%', Some(high), Some(low)) => {
                out.push((16 * high + low) as u8);
                at += 3;
            }
            _ => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8(out).unwrap_or_else(|_| text.to_owned())
}

/// RFC 4648, with padding or without.
fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let end = text.iter().rposition(|&c| c != b'=').map_or(0, |last| last + 1);
    if text.len() - end > 2 || end % 4 == 1 {
        return None;
    }
    let mut out = Vec::with_capacity(end / 4 * 3 + 2);
    for group in text[..end].chunks(4) {
        let mut bits = 0_u32;
        for &c in group {
            bits = bits << 6 | sextet(c)?;
        }
        bits <<= 6 * (4 - group.len());
        let [_, bytes @ ..] = bits.to_be_bytes();
        out.extend(&bytes[..group.len() - 1]);
    }
    Some(out)
}

fn sextet(c: u8) -> Option<u32> {
    let value = match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    };
    Some(value.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_rfc() {
        // RFC 4648, §10.
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("fooba", "Zm9vYmE=")] {
            assert_eq!(base64(coded.as_bytes()).as_deref(), Some(plain.as_bytes()));
            assert_eq!(base64(coded.trim_end_matches('=').as_bytes()).as_deref(), Some(plain.as_bytes()));
        }
        for damaged in ["Z", "Zm9vY", "Zm9*", "Zm=v", "===="] {
            assert_eq!(base64(damaged.as_bytes()), None, "{damaged}");
        }
    }

    #[test]
    fn spaces_of_file_names_are_written_as_percent_20() {
        let Ok(Uri::Files([first, second])) = Uri::read("my%20mesh%.bin", Path::new("f")) else { panic!("not a file") };
        assert_eq!((first, second), (PathBuf::from("f/my mesh%.bin"), PathBuf::from("f/my%20mesh%.bin")));
    }

    #[test]
    fn what_is_elsewhere_is_not_fetched() {
        assert!(Uri::read("https://example.org/a.bin", Path::new("")).unwrap_err().contains("nothing is fetched"));
        assert!(Uri::read("data:text/plain,hello", Path::new("")).unwrap_err().contains("not in base64"));
        assert!(Uri::read("data:nothing", Path::new("")).unwrap_err().contains("comma"));
    }
}
