//! `moorline completions` and `moorline man`: descriptions of the program's arguments for shells and for `man`.

use std::io;
use std::path::Path;

use clap::CommandFactory;
use clap_complete::Shell;
use moorline::output::write_file;

use crate::arguments::Arguments;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::terminal::print;

/// Name of the program.
const NAME: &str = "moorline";

/// Prints the completions of a shell.
pub(crate) fn completions(shell: Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), NAME, &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Prints the manual page of the program, or writes it and those of all commands into a folder.
pub(crate) fn man(folder: Option<&Path>) -> Result<(), Failure> {
    let mut program = Arguments::command();
    program.build();
    let Some(folder) = folder else {
        return print(&String::from_utf8_lossy(&page(program).map_err(Failure::Print)?));
    };
    let _open = Folder::open(folder)?;
    let commands = program
        .get_subcommands()
        .filter(|command| command.get_name() != "help");
    let mut count = 0;
    for command in std::iter::once(&program).chain(commands) {
        // `build` has named them moorline-run and so on
        let name = command.get_display_name().unwrap_or(NAME);
        let page = page(command.clone()).map_err(Failure::Print)?;
        write_file(&folder.join(format!("{name}.1")), |out| out.write_all(&page))?;
        count += 1;
    }
    print(&format!("{count} pages written to {}\n", folder.display()))
}

/// Manual page of a command.
fn page(command: clap::Command) -> io::Result<Vec<u8>> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command).render(&mut text)?;
    Ok(text)
}
