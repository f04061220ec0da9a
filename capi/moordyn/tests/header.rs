//! The header of the library is current, compiles without warnings in C and C++, and declares exactly the symbols of the library.

#[path = "../../tests/common/mod.rs"]
mod common;

use common::{Header, LANGUAGES};

const HEADER: Header = Header {
    package: env!("CARGO_MANIFEST_DIR"),
    path: "include/MoorDyn2.h",
    guard: "MOORLINE_MOORDYN2_H",
    title: "C interface of MoorDyn as moorline provides it. Written by cbindgen: do not edit.",
    note: "A handle is null or came from a function here; one that was closed is refused. Any thread may call; calls on one system wait for one \
           another.\n * Functions that return int return 0 or a code below 0, and write a sentence to the log of the system. Lines, points, rods, bodies \
           count from 1\n * in the deck's order, nodes and attachments from 0. SI units and radians throughout.",
    library: "moordyn",
};

#[test]
fn the_header_is_current() {
    HEADER.assert_current();
}

#[test]
fn the_header_is_clean_in_c_and_in_cplusplus() {
    for language in LANGUAGES {
        HEADER.assert_clean(language, "MoorDyn.h");
    }
}

#[test]
fn the_library_exports_exactly_the_functions_of_the_header() {
    HEADER.assert_symbols();
}
