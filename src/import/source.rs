//! A file that is read: its name as given, its digest, its text.

use std::io::Read;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::error::{ImportError, fault};
use super::text::Text;
use crate::dataset::{InputFile, Place};

/// The largest input file that is read: 64 MiB, a hundred times the text of a 17 x 17 scan in one file.
pub const MAX_FILE_BYTES: u64 = 64 * 1024 * 1024;

/// An input file, decoded.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    /// The name as the user or the manifest gave it.
    pub(crate) name: String,
    /// What goes into the receipt; dialect and record count are filled by the parser.
    pub(crate) input: InputFile,
    /// Its characters.
    pub(crate) text: Text,
}

impl Source {
    /// Reads and decodes the file at `path`, called `name` in messages.
    ///
    /// # Errors
    /// [`ImportError`] when it cannot be read, is larger than [`MAX_FILE_BYTES`], or is no text.
    pub(crate) fn read(path: &Path, name: &str) -> Result<Self, ImportError> {
        let unreadable = |source| ImportError::Unreadable { file: name.to_owned(), source };
        let file = std::fs::File::open(path).map_err(unreadable)?;
        let mut bytes = Vec::new();
        // One byte more than allowed: a pipe has no size to ask for.
        file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        Self::from_bytes(bytes, name)
    }

    /// The same from bytes.
    pub(crate) fn from_bytes(bytes: Vec<u8>, name: &str) -> Result<Self, ImportError> {
        if bytes.len() as u64 > MAX_FILE_BYTES {
            return Err(ImportError::Malformed(fault(
                Place::file(name),
                format!("more than {MAX_FILE_BYTES} bytes"),
                format!("a text of at most {MAX_FILE_BYTES} bytes"),
                "split it into several files",
            )));
        }
        if bytes.starts_with(b"\x89HDF\r\n\x1a\n") {
            return Err(ImportError::Malformed(fault(
                Place::file(name),
                "an HDF5 file",
                "a text of an instrument, a table or a manifest",
                "if it is a .bbrf file it is imported already: see `bbrf info`",
            )));
        }
        let digest = Sha256::digest(&bytes);
        let sha256 = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        let input =
            InputFile { name: name.to_owned(), sha256, bytes: bytes.len() as u64, dialect: String::new(), records: 0 };
        Ok(Self { name: name.to_owned(), input, text: Text::decode(bytes, name)? })
    }

    /// The place of a line of this file.
    pub(crate) fn at_line(&self, line: u64) -> Place {
        Place::file(self.name.as_str()).at_line(line)
    }
}
