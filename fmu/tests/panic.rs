//! A panic inside an entry point: the host survives, hears of it, and the instance serves nothing but free.
//! The library is built with the feature `provoke-panic`, which exports the function that panics.

mod common;

use std::ffi::c_void;

use moorline_host::{FmiVersion, HostError, Status};

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_panic_is_fatal_for_the_instance_and_harmless_for_the_host() {
    let fmu = common::open(FmiVersion::Two, &["provoke-panic"]);
    let mut lost = fmu.instantiate("lost", true).unwrap();
    let mut other = fmu.instantiate("other", true).unwrap();
    for slave in [&mut lost, &mut other] {
        slave.enter_initialization(0.0, None).unwrap();
        slave.exit_initialization().unwrap();
    }
    // SAFETY: the library was built with the feature, and the function has this signature.
    let provoke = unsafe {
        *fmu.library()
            .get::<unsafe extern "C" fn(*mut c_void) -> u32>(b"moorline_provoke_panic")
            .unwrap()
    };
    // SAFETY: the handle is live.
    let status = Status::from_c(unsafe { provoke(lost.handle()) });
    assert_eq!(status, Status::Fatal);
    let log = lost.take_log();
    let message = log.last().unwrap();
    assert_eq!(message.category, "logStatusFatal");
    assert!(message.text.contains("provoked") && message.text.contains("fmi2.rs"));

    match lost.do_step(0.0, 0.05).unwrap_err() {
        HostError::Call { status, .. } => assert_eq!(status, Status::Fatal),
        error => panic!("{error}"),
    }
    assert!(lost.reset().is_err());
    drop(lost);
    other.do_step(0.0, 0.05).unwrap();
}
