//! The descriptions in `modelDescription/` match the output of the program for `scenes/oc3_catenary.toml`, so a change of
//! the interface shows in the diff. After an intended change, regenerate them:
//! `MOORLINE_UPDATE=1 cargo test -p moorline-fmu --test description`.

use std::path::Path;

use moorline::output::description::Description;
use moorline::scene::Scene;
use moorline_host::FmiVersion;

#[test]
fn the_committed_descriptions_are_what_the_program_writes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let text = std::fs::read_to_string(root.join("scenes/oc3_catenary.toml")).unwrap();
    let scene = Scene::from_toml(&text).unwrap();
    for (version, name) in [(FmiVersion::Two, "fmi2.xml"), (FmiVersion::Three, "fmi3.xml")] {
        let path = root.join("modelDescription").join(name);
        let written = Description::new(&text, &scene, version).unwrap().xml;
        if std::env::var_os("MOORLINE_UPDATE").is_some() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &written).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap();
        for (line, (committed, written)) in committed.lines().zip(written.lines()).enumerate() {
            assert_eq!(committed, written, "{name}, line {}", line + 1);
        }
        assert_eq!(committed.len(), written.len(), "{name}");
    }
}
