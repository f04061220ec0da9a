//! Names in FMI of its versions, of platforms and of the libraries in an FMU.

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

/// Platform for which an FMU may have a library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Platform {
    /// Folders below `binaries/` in FMI 2.0 and 3.0.
    folders: [&'static str; 2],
    /// Extension of a library.
    extension: &'static str,
}

/// All platforms.
const PLATFORMS: [Platform; 5] = [
    Platform::new(["linux64", "x86_64-linux"], "so"),
    Platform::new(["aarch64-linux", "aarch64-linux"], "so"),
    Platform::new(["win64", "x86_64-windows"], "dll"),
    Platform::new(["darwin64", "x86_64-darwin"], "dylib"),
    Platform::new(["aarch64-darwin", "aarch64-darwin"], "dylib"),
];

impl Platform {
    const fn new(folders: [&'static str; 2], extension: &'static str) -> Platform {
        Platform { folders, extension }
    }

    /// Returns the platform with a name of FMI 3.0, such as `x86_64-linux`.
    pub fn of_name(name: &str) -> Option<Platform> {
        PLATFORMS.into_iter().find(|platform| platform.name() == name)
    }

    /// Returns the platform of this program; `None` if the standard has no name for it.
    pub fn this() -> Option<Platform> {
        let system = if cfg!(target_os = "macos") {
            "darwin"
        } else {
            std::env::consts::OS
        };
        Platform::of_name(&format!("{}-{system}", std::env::consts::ARCH))
    }

    /// Name in FMI 3.0.
    pub fn name(self) -> &'static str {
        self.folders[1]
    }

    /// Path of the library in an FMU.
    pub fn path(self, version: FmiVersion, model_identifier: &str) -> String {
        let folder = match version {
            FmiVersion::Two => self.folders[0],
            FmiVersion::Three => self.folders[1],
        };
        format!("binaries/{folder}/{model_identifier}.{}", self.extension)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_platform_has_the_folders_of_both_standards() {
        let paths = |name| {
            let platform = Platform::of_name(name).unwrap();
            [FmiVersion::Two, FmiVersion::Three].map(|version| platform.path(version, "m"))
        };
        assert_eq!(
            paths("x86_64-linux"),
            ["binaries/linux64/m.so", "binaries/x86_64-linux/m.so"]
        );
        assert_eq!(
            paths("x86_64-windows"),
            ["binaries/win64/m.dll", "binaries/x86_64-windows/m.dll"]
        );
        assert_eq!(paths("aarch64-darwin"), ["binaries/aarch64-darwin/m.dylib"; 2]);
        assert_eq!(Platform::of_name("vax-vms"), None);
    }
}
