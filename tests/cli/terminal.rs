//! Terminal output: completions, manual pages, readable numbers, and no colour or progress in
//! pipes.

use crate::cli::{command, stdout, text};

/// The commands that the program's help lists.
fn commands() -> Vec<String> {
    let help = stdout(&["--help"]);
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let lines = lines.take_while(|line| !line.is_empty());
    let names = lines.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// Every shell completes every command and its flags.
#[test]
fn every_shell_completes_all_commands() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = stdout(&["completions", shell]);
        for name in commands() {
            assert!(script.contains(&name), "{shell}: {name}");
        }
        assert!(script.contains("beside"), "{shell}: a flag of view");
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("man1");
    let said = stdout(&["man", "--out", text(&out)]);
    let names = commands();
    assert!(said.starts_with(&format!("{} pages", names.len() + 1)), "{said}");
    let page = |name: &str| std::fs::read_to_string(out.join(format!("{name}.1"))).unwrap();
    let first = page("sdop");
    assert!(first.starts_with(".ie") && first.contains(".TH sdop 1"), "{first}");
    for name in names {
        let page = page(&format!("sdop-{name}"));
        assert!(page.contains("SYNOPSIS") && page.contains("Example"), "{name}: {page}");
    }
}

/// Numbers of a mesh are plain decimals, and a flat mesh is reported as flat.
#[test]
fn flat_mesh_is_reported() {
    let shown = stdout(&["mesh", "data/meshes/teapot.tri"]);
    assert!(shown.contains("volume 32.5362 unit³") && shown.contains("size, unit³"), "{shown}");
    assert!(!shown.contains("flat"), "{shown}");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("flat.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let shown = stdout(&["mesh", text(&path)]);
    assert!(shown.contains("warning: the mesh is flat"), "{shown}");
    for number in shown.split_whitespace().filter(|word| word.parse::<f64>().is_ok()) {
        for odd in ["e", "-0", "0000000"] {
            assert!(!number.contains(odd), "{number}: {shown}");
        }
    }
}

/// Piped output has neither colour nor progress.
#[test]
fn piped_output_is_plain() {
    let scene = ["run", "data/scenes/paper-50.toml", "--frames", "3"];
    let missing = ["mesh", "no-such-file.tri"];
    for (args, colour) in [(&scene[..], None), (&missing[..], None), (&missing[..], Some("1"))] {
        let mut command = command(args);
        command.env_remove("NO_COLOR");
        if let Some(value) = colour {
            command.env("NO_COLOR", value).env("CLICOLOR_FORCE", "0");
        }
        let output = command.output().unwrap();
        let both = [output.stdout, output.stderr].concat();
        assert!(!both.contains(&0x1b), "{args:?}: {}", String::from_utf8_lossy(&both));
        assert!(!both.contains(&b'\r'), "{args:?}");
    }
    let output = command(&scene).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
