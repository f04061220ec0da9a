//! The C types of FMI 2.0 and 3.0, and a small host: it opens a co-simulation FMU, loads its library and drives it
//! through the C interface, as any other host would.
//!
//! ```no_run
//! # fn main() -> Result<(), moorline_host::HostError> {
//! let fmu = moorline_host::Fmu::open("line.fmu".as_ref())?;
//! let mut slave = fmu.instantiate("mooring", false)?;
//! slave.enter_initialization(0.0, None)?;
//! slave.exit_initialization()?;
//! let fairlead_x = fmu.reference("fairlead.x")?;
//! slave.set_real(&[fairlead_x], &[0.1])?;
//! slave.do_step(0.0, 0.05)?;
//! println!("{} N", slave.real("line1.tension_b")?);
//! # Ok(()) }
//! ```

/// Generates from the list of a standard's functions a pointer type for each and the table that a host resolves.
macro_rules! function_table {
    ($($name:ident: $type:ident = fn($($argument:ty),*) -> $result:ty;)*) => {
        $(
            #[doc = concat!("Type of `", stringify!($name), "`.")]
            pub type $type = unsafe extern "C" fn($($argument),*) -> $result;
        )*

        /// Every function of the standard, as found in a library.
        #[derive(Debug, Clone, Copy)]
        pub struct Functions {
            $(
                #[doc = concat!("`", stringify!($name), "`.")]
                pub $name: $type,
            )*
        }

        impl Functions {
            /// Names of all functions.
            pub const NAMES: &[&str] = &[$(stringify!($name)),*];

            /// Finds every function in a library.
            ///
            /// # Errors
            /// Names the first one that is missing.
            ///
            /// # Safety
            /// The library's functions of these names must have the standard's signatures, and the table must not be
            /// used after the library is unloaded.
            pub unsafe fn resolve(library: &libloading::Library) -> Result<Self, crate::HostError> {
                Ok(Functions {
                    // SAFETY: the caller vouches for the signatures; the pointers are copied out and live as long as
                    // the library, which the caller keeps.
                    $($name: *unsafe { library.get::<$type>(stringify!($name)) }
                        .map_err(|_| crate::HostError::MissingFunction(stringify!($name)))?,)*
                })
            }
        }
    };
}

mod archive;
mod description;
pub mod fmi2;
pub mod fmi3;
mod fmu;
mod log;
mod replay;
mod slave;
mod status;

pub use description::{Causality, Description, Variable, VariableType};
pub use fmu::{Fmu, HostError};
pub use log::LogMessage;
pub use moorline::output::fmi::FmiVersion;
pub use replay::{Deviation, Replay, replay};
pub use slave::{SavedState, Slave};
pub use status::Status;
