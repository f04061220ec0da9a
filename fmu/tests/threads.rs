//! An instance that distributes its lines over threads is freed, and its library unloaded, like any other.

mod common;

use moorline_host::FmiVersion;

/// Two separate lines, on two threads.
fn two_lines() -> String {
    let second = common::SCENE.split("[[points]]").skip(1).collect::<Vec<_>>();
    let second = format!("[[points]]{}", second.join("[[points]]"));
    let second = ["anchor", "fairlead", "line1"]
        .into_iter()
        .fold(second, |text, name| text.replace(name, &format!("{name}_2")));
    format!("{}{second}\n[solver]\nthreads = 2\n", common::SCENE)
}

#[test]
fn a_thread_of_the_host_outlives_the_library_whose_instances_had_threads() {
    let scene = two_lines();
    for _ in 0..3 {
        let fmu = common::open_scene(FmiVersion::Two, &scene);
        let host = std::thread::spawn(move || {
            let mut slave = fmu.instantiate("pair", true).unwrap();
            slave.enter_initialization(0.0, None).unwrap();
            slave.exit_initialization().unwrap();
            for step in 0..20 {
                slave.do_step(0.05 * f64::from(step), 0.05).unwrap();
            }
            drop(slave);
            drop(fmu);
        });
        host.join().unwrap();
    }
}
