//! Link arguments of a Python module: on macOS the interpreter provides its symbols when the module is loaded.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
