//! Opened FMU: its unpacked folder, description and loaded library.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use tempfile::TempDir;

use crate::{Description, FmiVersion, Slave, Status, Variable, archive, fmi2, fmi3};

/// Errors of a host.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// The container cannot be read.
    #[error("{}: {problem}", path.display())]
    Archive {
        /// The .fmu file.
        path: PathBuf,
        /// Fault of the file.
        problem: String,
    },
    /// The description cannot be used.
    #[error("modelDescription.xml: {0}")]
    Description(String),
    /// FMI defines no binaries folder for this platform.
    #[error("FMI names no binaries folder for this platform")]
    Platform,
    /// The library cannot be loaded.
    #[error("{}: {problem}", path.display())]
    Library {
        /// The library.
        path: PathBuf,
        /// The loader's message.
        problem: String,
    },
    /// The library lacks a function of the standard.
    #[error("the library has no function {0}")]
    MissingFunction(&'static str),
    /// No variable has this name.
    #[error("the FMU has no variable \"{0}\"")]
    UnknownVariable(String),
    /// The FMU refused to be instantiated.
    #[error("the FMU refused to be instantiated: {0}")]
    Instantiate(String),
    /// The reference results of the FMU are missing or cannot be used.
    #[error("reference results: {0}")]
    Reference(String),
    /// A text or a number of values that cannot be passed to C.
    #[error("{0}")]
    Argument(String),
    /// A call returned a status other than success.
    #[error("{function} returned {status:?}: {log}")]
    Call {
        /// The function of the standard.
        function: &'static str,
        /// Status returned.
        status: Status,
        /// Messages in the FMU's log.
        log: String,
    },
}

/// Functions of the FMU's version.
#[derive(Debug)]
pub(crate) enum Api {
    Two(Box<fmi2::Functions>),
    Three(Box<fmi3::Functions>),
}

/// Contents of an opened FMU. `library` precedes `folder`, since it must be unloaded before its file is removed.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) api: Api,
    pub(crate) description: Description,
    pub(crate) library: libloading::Library,
    pub(crate) folder: TempDir,
}

/// Opened FMU. Its instances keep it open.
#[derive(Debug, Clone)]
pub struct Fmu(pub(crate) Arc<Loaded>);

impl Fmu {
    /// Unpacks an FMU into a separate folder and loads its library.
    ///
    /// # Errors
    /// The container, description or library cannot be used.
    pub fn open(path: &Path) -> Result<Fmu, HostError> {
        let folder = archive::unpack(path)?;
        let text = std::fs::read_to_string(folder.path().join("modelDescription.xml")).map_err(|e| {
            HostError::Archive {
                path: path.to_path_buf(),
                problem: format!("modelDescription.xml: {e}"),
            }
        })?;
        let description = Description::from_xml(&text)?;
        let library_path =
            archive::library_path(folder.path(), description.version, &description.model_identifier)?;
        // SAFETY: loading runs the library's initialisers. Opening an FMU includes this; the user chose the file.
        let library = unsafe { libloading::Library::new(&library_path) }.map_err(|e| HostError::Library {
            path: library_path,
            problem: e.to_string(),
        })?;
        // SAFETY: a library in an FMU of this version has the standard's functions with the standard's signatures; the
        // table is kept with the library and never used after it.
        let api = unsafe {
            match description.version {
                FmiVersion::Two => Api::Two(Box::new(fmi2::Functions::resolve(&library)?)),
                FmiVersion::Three => Api::Three(Box::new(fmi3::Functions::resolve(&library)?)),
            }
        };
        Ok(Fmu(Arc::new(Loaded {
            api,
            description,
            library,
            folder,
        })))
    }

    /// Returns the FMU's description.
    pub fn description(&self) -> &Description {
        &self.0.description
    }

    /// Returns the folder that contains the unpacked FMU.
    pub fn folder(&self) -> &Path {
        self.0.folder.path()
    }

    /// Returns the loaded library, for functions outside the standard.
    pub fn library(&self) -> &libloading::Library {
        &self.0.library
    }

    /// Returns the value reference of a variable.
    ///
    /// # Errors
    /// No variable has this name.
    pub fn reference(&self, name: &str) -> Result<u32, HostError> {
        Ok(self.variable(name)?.reference)
    }

    /// Returns the variable of this name.
    ///
    /// # Errors
    /// No variable has this name.
    pub fn variable(&self, name: &str) -> Result<&Variable, HostError> {
        let found = self
            .description()
            .variables
            .iter()
            .find(|variable| variable.name == name);
        found.ok_or_else(|| HostError::UnknownVariable(name.to_string()))
    }

    /// Creates a co-simulation instance; `logging` turns the FMU's log on.
    ///
    /// # Errors
    /// The FMU refuses; the error holds its log.
    pub fn instantiate(&self, name: &str, logging: bool) -> Result<Slave, HostError> {
        Slave::new(self, name, &self.description().token, logging)
    }

    /// Works like [`Fmu::instantiate`], with a token other than the description's: an FMU must refuse it.
    ///
    /// # Errors
    /// The FMU refuses; the error holds its log.
    pub fn instantiate_with_token(&self, name: &str, token: &str, logging: bool) -> Result<Slave, HostError> {
        Slave::new(self, name, token, logging)
    }
}
