//! Texts as instruments and spreadsheets leave them: encodings and line ends.

use super::error::{ImportError, fault, quoted};
use crate::dataset::Place;

/// The encodings that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// UTF-8, with or without a byte order mark; ASCII is one.
    Utf8,
    /// UTF-16, little-endian, with a byte order mark.
    Utf16Le,
    /// UTF-16, big-endian, with a byte order mark.
    Utf16Be,
    /// What is not UTF-8 and has no mark: Windows-1252, of which Latin-1 is the printable part.
    Windows1252,
}

impl Encoding {
    /// The name in receipts.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Utf8 => "UTF-8",
            Self::Utf16Le => "UTF-16LE",
            Self::Utf16Be => "UTF-16BE",
            Self::Windows1252 => "Windows-1252",
        }
    }
}

/// A decoded text whose lines all end in a line feed. CR, LF and CRLF each count as one line end.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    raw: Vec<u8>,
    mark: usize,
    /// How the bytes were read.
    pub(crate) encoding: Encoding,
    /// The decoded characters.
    pub(crate) content: String,
}

/// A line that is not blank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Line<'a> {
    /// Number, from 1.
    pub(crate) number: u64,
    /// Its characters without the line end; not trimmed.
    pub(crate) text: &'a str,
}

impl Text {
    /// Decodes the bytes of a file called `name`.
    ///
    /// # Errors
    /// [`ImportError::Malformed`] for an empty file, U+0000 and broken UTF-16.
    pub(crate) fn decode(raw: Vec<u8>, name: &str) -> Result<Self, ImportError> {
        let (encoding, mark) = match raw.as_slice() {
            [0xEF, 0xBB, 0xBF, ..] => (Encoding::Utf8, 3),
            [0xFF, 0xFE, ..] => (Encoding::Utf16Le, 2),
            [0xFE, 0xFF, ..] => (Encoding::Utf16Be, 2),
            other if std::str::from_utf8(other).is_ok() => (Encoding::Utf8, 0),
            _ => (Encoding::Windows1252, 0),
        };
        let body = &raw[mark..];
        let decoder = match encoding {
            Encoding::Utf8 => encoding_rs::UTF_8,
            Encoding::Utf16Le => encoding_rs::UTF_16LE,
            Encoding::Utf16Be => encoding_rs::UTF_16BE,
            Encoding::Windows1252 => encoding_rs::WINDOWS_1252,
        };
        let (decoded, broken) = decoder.decode_without_bom_handling(body);
        if broken {
            return Err(ImportError::Malformed(fault(
                Place::file(name),
                format!("bytes that are not {}", encoding.name()),
                "a text in UTF-8, UTF-16 with a byte order mark, or Latin-1",
                "save it as UTF-8",
            )));
        }
        let content = decoded.replace("\r\n", "\n").replace('\r', "\n");
        let text = Self { encoding, mark, content, raw };
        text.refuse_empty(name)?;
        text.refuse_nul(name)?;
        Ok(text)
    }

    fn refuse_empty(&self, name: &str) -> Result<(), ImportError> {
        if self.content.trim().is_empty() {
            return Err(ImportError::Malformed(fault(
                Place::file(name),
                format!("an empty file ({} bytes, no text)", self.raw.len()),
                "spectra, a table or a manifest",
                "export it again",
            )));
        }
        Ok(())
    }

    fn refuse_nul(&self, name: &str) -> Result<(), ImportError> {
        let Some(line) = self.lines().find(|line| line.text.contains('\0')) else { return Ok(()) };
        let position = line.text.find('\0').unwrap_or(0);
        Err(ImportError::Malformed(fault(
            Place::file(name).at_line(line.number).at_byte(self.byte_offset(line, position)),
            "U+0000",
            "a text without zero bytes",
            "if it is UTF-16, save it with a byte order mark; if it is binary, export it as text",
        )))
    }

    /// The lines that are not blank, with their numbers.
    pub(crate) fn lines(&self) -> impl Iterator<Item = Line<'_>> + Clone {
        self.content
            .split('\n')
            .zip(1_u64..)
            .map(|(text, number)| Line { number, text })
            .filter(|line| !line.text.trim().is_empty())
    }

    /// The content from a line on.
    pub(crate) fn rest_from(&self, number: u64) -> &str {
        let skip = usize::try_from(number.saturating_sub(1)).unwrap_or(usize::MAX);
        let start = self.content.match_indices('\n').nth(skip.saturating_sub(1)).map_or(0, |(at, _)| at + 1);
        if skip == 0 { &self.content } else { &self.content[start..] }
    }

    /// The byte offset in the file of `position` (a byte index into the line's decoded text).
    pub(crate) fn byte_offset(&self, line: Line<'_>, position: usize) -> u64 {
        let before = &line.text[..position];
        let start = self.line_start(line.number);
        let width = match self.encoding {
            Encoding::Utf8 => before.len(),
            Encoding::Windows1252 => before.chars().count(),
            Encoding::Utf16Le | Encoding::Utf16Be => 2 * before.encode_utf16().count(),
        };
        (start + width) as u64
    }

    /// The byte at that offset of the file, if there is one.
    pub(crate) fn byte_at(&self, offset: u64) -> Option<u8> {
        usize::try_from(offset).ok().and_then(|index| self.raw.get(index)).copied()
    }

    fn line_start(&self, number: u64) -> usize {
        let unit = |index: usize| match self.encoding {
            Encoding::Utf16Le => self.raw.get(index..index + 2).map(|two| u16::from_le_bytes([two[0], two[1]])),
            Encoding::Utf16Be => self.raw.get(index..index + 2).map(|two| u16::from_be_bytes([two[0], two[1]])),
            _ => self.raw.get(index).copied().map(u16::from),
        };
        let width = if matches!(self.encoding, Encoding::Utf16Le | Encoding::Utf16Be) { 2 } else { 1 };
        let (mut index, mut line) = (self.mark, 1);
        while line < number {
            match unit(index) {
                None => break,
                Some(10) => line += 1,
                // A CRLF is counted at its LF.
                Some(13) if unit(index + width) != Some(10) => line += 1,
                Some(_) => {}
            }
            index += width;
        }
        index
    }

    /// Refuses a line with a character outside ASCII, where only numbers may stand.
    pub(crate) fn require_ascii(&self, line: Line<'_>, name: &str) -> Result<(), ImportError> {
        let Some(position) = line.text.find(|c: char| !c.is_ascii()) else { return Ok(()) };
        let offset = self.byte_offset(line, position);
        let byte = self.byte_at(offset).unwrap_or(0);
        Err(ImportError::Malformed(fault(
            Place::file(name).at_line(line.number).at_byte(offset),
            format!("the byte 0x{byte:02x} in {}", quoted(line.text.trim())),
            "digits, `.`, `,`, `E`, `+` and `-`: a spectrum of this format holds nothing else",
            "the file was damaged on its way; read it from the instrument again",
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(raw: &[u8]) -> Vec<(u64, String)> {
        let text = Text::decode(raw.to_vec(), "t").unwrap();
        text.lines().map(|line| (line.number, line.text.to_owned())).collect()
    }

    #[test]
    fn every_line_end_is_one() {
        let expected = vec![(1, "a".to_owned()), (2, "b".to_owned()), (4, "c".to_owned()), (5, "d".to_owned())];
        assert_eq!(lines(b"a\rb\r\n\nc\nd"), expected);
    }

    #[test]
    fn every_encoding_is_read() {
        assert_eq!(lines(b"\xEF\xBB\xBFa"), [(1, "a".to_owned())]);
        assert_eq!(lines(b"\xFF\xFEa\0\r\0\n\0b\0"), [(1, "a".to_owned()), (2, "b".to_owned())]);
        assert_eq!(lines(b"\xFE\xFF\0a"), [(1, "a".to_owned())]);
        assert_eq!(lines(b"cd/m\xb2"), [(1, "cd/m²".to_owned())]);
    }

    #[test]
    fn offsets_are_those_of_the_file() {
        for (raw, offset) in [
            (&b"a\r\nb\rc\n05\xe80."[..], 9),
            (&b"a\n\nc\n05\xe80."[..], 7),
            (&b"\xEF\xBB\xBFa\r\nb\nc\n05\xc3\xa80"[..], 12),
        ] {
            let text = Text::decode(raw.to_vec(), "t").unwrap();
            let last = text.lines().last().unwrap();
            assert_eq!(last.number, 4);
            let position = last.text.find('è').unwrap();
            assert_eq!(text.byte_offset(last, position), offset);
        }
        let mut wide = vec![0xFF, 0xFE];
        wide.extend("a\r\nbé".encode_utf16().flat_map(u16::to_le_bytes));
        let text = Text::decode(wide, "t").unwrap();
        let last = text.lines().last().unwrap();
        assert_eq!(text.byte_offset(last, 1), 2 + 2 * 4);
    }

    #[test]
    fn empty_and_zero_bytes_are_refused() {
        assert!(Text::decode(b" \r\n".to_vec(), "t").unwrap_err().to_string().contains("empty file"));
        let message = Text::decode(b"a\n0\0".to_vec(), "t").unwrap_err().to_string();
        assert!(message.contains("line 2") && message.contains("byte 3"), "{message}");
    }

    #[test]
    fn the_rest_of_a_text_starts_at_a_line() {
        let text = Text::decode(b"a\rb\r\nc".to_vec(), "t").unwrap();
        assert_eq!((text.rest_from(1), text.rest_from(2), text.rest_from(3)), ("a\nb\nc", "b\nc", "c"));
    }
}
