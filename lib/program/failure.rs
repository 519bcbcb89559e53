//! How a program ends that has not done all that it was asked for.

use std::fmt;

/// Why a program did not do what it was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// What was asked for makes no sense: exit code 2.
    Usage(String),
    /// It made sense and did not work; the text names the file and the cause: exit code 1.
    Runtime(String),
    /// The reader of the output has gone away (`… --list | head -1`): a quiet end.
    ClosedPipe,
}

impl Failure {
    /// The exit code that tells a shell of this failure.
    #[must_use]
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Runtime(_) => 1,
            Self::ClosedPipe => 0,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(reason) | Self::Runtime(reason) => f.write_str(reason),
            Self::ClosedPipe => Ok(()),
        }
    }
}

impl std::error::Error for Failure {}
