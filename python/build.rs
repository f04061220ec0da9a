//! Link arguments of a Python module: on macOS the interpreter gives it its symbols when it is loaded.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
