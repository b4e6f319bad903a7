//! Text of files: UTF-8, UTF-16 with a mark at its beginning, else Latin-1; and its lines, numbered.

use crate::error::{BakeError, Place};
use std::borrow::Cow;
use std::path::Path;

/// The text that some bytes are.
pub(crate) fn decode<'a>(bytes: &'a [u8], path: &Path) -> Result<Cow<'a, str>, BakeError> {
    let wide = |bytes: &[u8], to: fn([u8; 2]) -> u16| {
        char::decode_utf16(bytes.as_chunks().0.iter().map(|pair| to(*pair)))
            .map(|character| character.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect::<String>()
    };
    Ok(match bytes {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes).into(),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes).into(),
        _ if bytes.contains(&0) => {
            return Err(Place::file(path).error("is no text: there is a byte of 0 in it"));
        }
        _ => {
            let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            match std::str::from_utf8(bytes) {
                Ok(text) => text.into(),
                Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect::<String>().into(),
            }
        }
    })
}

/// Lines without comments, of which one that ends with `\` goes on in the next; each with the number of its first.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    // Each of \n, \r\n and \r ends a line.
    let mut number = 0;
    let mut rest = text;
    let mut next = move || {
        if rest.is_empty() {
            return None;
        }
        let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let line = &rest[..end];
        rest = &rest[end..];
        rest = rest.strip_prefix("\r\n").or_else(|| rest.strip_prefix(['\n', '\r'])).unwrap_or(rest);
        number += 1;
        Some((number, line))
    };
    std::iter::from_fn(move || {
        let (number, line) = next()?;
        let mut line = Cow::Borrowed(line);
        while let Some(start) = line.trim_end().strip_suffix('\\').map(str::to_owned) {
            let Some((_, more)) = next() else { break };
            line = format!("{start} {more}").into();
        }
        let end = line.find('#').unwrap_or(line.len());
        let line = match line {
            Cow::Borrowed(line) => Cow::Borrowed(line[..end].trim()),
            Cow::Owned(line) => line[..end].trim().to_owned().into(),
        };
        Some((number, line))
    })
    .filter(|(_, line)| !line.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_numbered_joined_and_without_comments() {
        let text = "a 1\r\n\n# no\rb \\\n 2 # more\nc\\";
        let found: Vec<_> = lines(text).map(|(number, line)| (number, line.into_owned())).collect();
        assert_eq!(found, [(1, "a 1".into()), (4, "b   2".into()), (6, "c\\".into())]);
    }

    #[test]
    fn text_is_found_in_four_encodings() {
        let path = Path::new("a.obj");
        let decoded =
            |bytes: &[u8]| decode(bytes, path).map(Cow::into_owned).map_err(|error| error.to_string());
        assert_eq!(decoded(b"v 1").as_deref(), Ok("v 1"));
        assert_eq!(decoded(b"\xef\xbb\xbfv").as_deref(), Ok("v"));
        assert_eq!(decoded(b"\xfe\xff\0v\0 ").as_deref(), Ok("v "));
        assert_eq!(decoded(b"\xff\xfev\0 \0").as_deref(), Ok("v "));
        assert_eq!(decoded(b"M\xfcller").as_deref(), Ok("Müller"));
        assert_eq!(decoded(b"v\0").unwrap_err(), "a.obj: is no text: there is a byte of 0 in it");
    }
}
