//! `moorline completions` and `moorline man`: every command and every option is named.

use super::*;

/// Commands and their long options, from the help.
fn known(folder: &Folder) -> Vec<(String, Vec<String>)> {
    let help = folder.done("--help");
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands = commands.take_while(|line| !line.trim().is_empty());
    // descriptions of several lines are indented further
    let commands = commands.filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    let names = commands.filter_map(|line| line.split_whitespace().next());
    let names: Vec<&str> = names.filter(|name| *name != "help").collect();
    assert!(names.contains(&"sweep") && names.contains(&"run"), "{names:?}");
    let options = |name: &str| {
        let help = folder.done(&format!("{name} --help"));
        let first = help.lines().filter_map(|line| {
            let words = line.trim_start();
            words
                .starts_with('-')
                .then(|| words.split([' ', ',']).find(|word| word.starts_with("--")))?
        });
        first.map(String::from).collect()
    };
    names
        .into_iter()
        .map(|name| (name.to_string(), options(name)))
        .collect()
}

#[test]
fn completions_name_every_command_and_option_for_every_shell() {
    let folder = folder();
    let known = known(&folder);
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let text = folder.done(&format!("completions {shell}"));
        for (command, options) in &known {
            assert!(text.contains(command.as_str()), "{shell}: {command}");
            for option in options {
                // fish writes `-l resume`
                let name = option.trim_start_matches('-');
                assert!(
                    text.contains(option) || text.contains(&format!("-l {name}")),
                    "{shell}: {command} {option}"
                );
            }
        }
    }
    let output = folder.run("completions tcsh");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn manual_pages_name_every_command_and_option() {
    let folder = folder();
    let plain = |text: String| text.replace('\\', "");
    let program = plain(folder.done("man"));
    folder.shows("man -o pages", &["pages written to pages"]);
    assert_eq!(plain(folder.read("pages/moorline.1")), program);
    for (command, options) in known(&folder) {
        assert!(program.contains(&format!("moorline-{command}")), "{command}");
        let page = plain(folder.read(&format!("pages/moorline-{command}.1")));
        for option in options {
            assert!(page.contains(&option), "{command} {option}");
        }
    }
}
