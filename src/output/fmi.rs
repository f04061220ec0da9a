//! Names that FMI gives to its versions, to platforms and to the libraries in an FMU.

use std::fmt;

/// Version of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FmiVersion {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

impl fmt::Display for FmiVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            FmiVersion::Two => "2.0",
            FmiVersion::Three => "3.0",
        })
    }
}

/// Folder below `binaries/` for this platform; `None` where the standard names none.
pub fn platform(version: FmiVersion) -> Option<&'static str> {
    let folders = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        ["linux64", "x86_64-linux"]
    } else if cfg!(all(target_os = "linux", target_arch = "aarch64")) {
        ["aarch64-linux", "aarch64-linux"]
    } else if cfg!(all(target_os = "macos", target_arch = "x86_64")) {
        ["darwin64", "x86_64-darwin"]
    } else if cfg!(all(target_os = "macos", target_arch = "aarch64")) {
        ["aarch64-darwin", "aarch64-darwin"]
    } else if cfg!(all(windows, target_arch = "x86_64")) {
        ["win64", "x86_64-windows"]
    } else {
        return None;
    };
    Some(match version {
        FmiVersion::Two => folders[0],
        FmiVersion::Three => folders[1],
    })
}

/// File name of an FMU's library on this platform.
pub fn library_name(model_identifier: &str) -> String {
    let extension = if cfg!(windows) {
        "dll"
    } else if cfg!(target_os = "macos") {
        "dylib"
    } else {
        "so"
    };
    format!("{model_identifier}.{extension}")
}
