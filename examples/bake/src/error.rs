//! What goes wrong, and what only looks wrong.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why a file is not baked. It says which file, and where it can which line.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// A file cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// There is something in a file that cannot be.
    #[error("{place}: {problem}")]
    Content {
        /// Where.
        place: Place,
        /// What.
        problem: String,
    },
    /// [`Bake::strict`](crate::Bake::strict) was asked for, and there are warnings.
    #[error("{} of these {}, and none is allowed:\n{}", .0.len(), if .0.len() == 1 { "warning" } else { "warnings" }, lines(.0))]
    Warnings(Vec<Warning>),
}

fn lines(warnings: &[Warning]) -> String {
    warnings.iter().map(|warning| format!("    {warning}")).collect::<Vec<_>>().join("\n")
}

/// As [`fmt::Display`]: it is what a build script that returns an error prints.
impl fmt::Debug for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A file, and a line in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1, of a file of text.
    pub line: Option<usize>,
}

impl Place {
    pub(crate) fn file(path: &Path) -> Self {
        Self { path: path.to_owned(), line: None }
    }

    pub(crate) fn line(path: &Path, line: usize) -> Self {
        Self { path: path.to_owned(), line: Some(line) }
    }

    pub(crate) fn error(self, problem: impl Into<String>) -> BakeError {
        BakeError::Content { place: self, problem: problem.into() }
    }

    pub(crate) fn warning(self, text: impl Into<String>) -> Warning {
        Warning { place: self, text: text.into() }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        self.line.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

/// What is baked all the same, but may not be what was meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where.
    pub place: Place,
    /// What.
    pub text: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.text)
    }
}

pub(crate) fn read(path: &Path) -> Result<Vec<u8>, BakeError> {
    std::fs::read(path).map_err(|source| BakeError::Read { path: path.to_owned(), source })
}
