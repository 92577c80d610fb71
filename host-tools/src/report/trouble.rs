//! Why a point, or a whole sweep, has no figures.

use core_rt::blob::BlobError;
use firmware_rt::status::Status;
use thiserror::Error;

use super::page::PageError;
use super::store::StoreError;
use crate::compare::SizeMismatch;
use crate::emulate::EmulateError;
use crate::files::FileError;
use crate::picture::PictureError;
use crate::prepare::PrepareError;

/// Why a sweep ended before its end. What was measured until then is kept.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The rows.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A picture.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// No scene could be read.
    #[error("{0}")]
    NoScene(String),
    /// No thread.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The page could not be drawn.
    #[error(transparent)]
    Page(#[from] PageError),
}

/// Why a point has no figures.
#[derive(Debug)]
pub(super) enum Trouble {
    /// The scene and the machine do not go together: an answer, which stays.
    Unfit(String),
    /// Something else failed: measured again by the next run.
    Broken(String),
    /// Nothing more can be kept.
    Stop(SweepError),
}

impl<E: Into<SweepError>> From<E> for Trouble {
    fn from(error: E) -> Self {
        Self::Stop(error.into())
    }
}

impl Trouble {
    pub(super) fn prepare(error: PrepareError) -> Self {
        Self::Unfit(error.to_string())
    }

    /// A blob just made is refused, or a picture just drawn has another size.
    pub(super) fn blob(error: BlobError) -> Self {
        Self::Broken(error.to_string())
    }

    pub(super) fn size(error: SizeMismatch) -> Self {
        Self::Broken(error.to_string())
    }

    pub(super) fn emulate(error: EmulateError) -> Self {
        match &error {
            EmulateError::TooLarge { .. } | EmulateError::NoFirmware { .. } => Self::Unfit(error.to_string()),
            EmulateError::Firmware { status: Status::StackOverflow | Status::Storage, .. } => {
                Self::Unfit(error.to_string())
            }
            EmulateError::Build { package, output } => match output.lines().find(|line| line.contains("overflowed by"))
            {
                // What the linker says of a region that is too small.
                Some(line) => Self::Unfit(format!("the firmware {package} does not fit: {}", line.trim())),
                None => Self::Broken(error.to_string()),
            },
            _ => Self::Broken(error.to_string()),
        }
    }
}
