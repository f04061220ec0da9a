//! The header of the library is current, compiles without warnings in C and C++, and declares exactly the symbols of the library.

mod common;

use common::{Header, LANGUAGES};

const HEADER: Header = Header {
    package: env!("CARGO_MANIFEST_DIR"),
    path: "include/moorline.h",
    guard: "MOORLINE_H",
    title: "moorline as a library for C. Written by cbindgen: do not edit.",
    note: "A handle is null or came from moorline_load or moorline_read; one that was closed is refused. Any thread may call; calls on one\n \
           * simulation wait for one another. Functions that return int return MOORLINE_OK or another code, with a sentence for moorline_message.\n \
           * SI units and radians throughout; z is up, and forces are those that the mooring applies.",
    library: "moorline_c",
};

#[test]
fn the_header_is_current() {
    HEADER.assert_current();
}

#[test]
fn the_header_is_clean_in_c_and_in_cplusplus() {
    for language in LANGUAGES {
        HEADER.assert_clean(language, "moorline.h");
    }
}

#[test]
fn the_library_exports_exactly_the_functions_of_the_header() {
    HEADER.assert_symbols();
}
