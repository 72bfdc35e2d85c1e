//! The circumstances of a measurement: the command to repeat it, the machine, and its other load.

use std::fmt::{self, Display, Formatter};
use std::fs;
use std::path::Path;

use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop::Tier;
use sdop_bench::measure::machine::Machine;
use serde::Serialize;

/// The features that compile the same engines in.
fn features() -> String {
    let compiled = [
        (cfg!(feature = "physx"), "physx"),
        (cfg!(feature = "debian"), "debian"),
        (cfg!(feature = "box3d"), "box3d"),
    ];
    let names = compiled.into_iter().filter(|(is_in, _)| *is_in);
    let names = names.map(|(_, name)| name).collect::<Vec<_>>().join(",");
    match names.as_str() {
        "" => String::new(),
        names => format!(" --features {names}"),
    }
}

/// The circumstances of a measurement.
#[derive(Serialize)]
pub struct Facts {
    command: String,
    machine: Machine,
    /// CPU features for which engines in Rust were compiled; ours detects them at run time.
    compiled_for: &'static str,
    /// What else ran, in the measurer's words.
    note: String,
    /// Processes waiting for a CPU, one minute's mean, at the beginning and by now.
    load: [String; 2],
}

impl Facts {
    /// Here and now.
    pub fn new(note: String) -> Self {
        Self {
            command: command(),
            machine: Machine::here(Tier::detect()),
            compiled_for: match (cfg!(target_feature = "avx512f"), cfg!(target_feature = "avx2")) {
                (true, _) => "AVX-512",
                (_, true) => "AVX2",
                _ => "the architecture's baseline",
            },
            note,
            load: [load(), load()],
        }
    }

    /// Looks at the load once more.
    pub fn look_again(&mut self) {
        self.load[1] = load();
    }
}

/// An engine that took too long in a case of type `C`.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LeftOut<C> {
    /// The case.
    #[serde(flatten)]
    pub case: C,
    /// The engine.
    pub engine: &'static str,
    /// Milliseconds that it took for the frame that gave the reason.
    pub ms: f64,
    /// Milliseconds that it had.
    pub limit_ms: f64,
}

/// What was timed: a row of type `R` per case of type `C` and engine, in the order of engines.
#[derive(Serialize)]
pub struct Timings<R, C> {
    /// Those that kept to the limit.
    pub rows: Vec<R>,
    /// Those without a row.
    pub left_out: Vec<LeftOut<C>>,
}

/// A measurement.
#[derive(Serialize)]
pub struct Record<R, C> {
    #[serde(flatten)]
    pub facts: Facts,
    #[serde(flatten)]
    pub timings: Timings<R, C>,
}

impl<R, C> Record<R, C> {
    /// An empty record of this machine.
    pub fn new(note: String) -> Self {
        Self {
            facts: Facts::new(note),
            timings: Timings { rows: Vec::new(), left_out: Vec::new() },
        }
    }

    /// Adds a case.
    pub fn add(&mut self, timings: Timings<R, C>) {
        self.facts.look_again();
        self.timings.rows.extend(timings.rows);
        self.timings.left_out.extend(timings.left_out);
    }
}

/// `sdop record`'s command where it runs this, or this one's.
fn command() -> String {
    std::env::var("SDOP_COMMAND").unwrap_or_else(|_| {
        let arguments: Vec<_> = std::env::args().skip(1).map(quoted).collect();
        let (features, arguments) = (features(), arguments.join(" "));
        format!("cargo run --release -p sdop-peers{features} -- {arguments}")
    })
}

/// As a list in Markdown.
impl Display for Facts {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [before, now] = &self.load;
        writeln!(f, "- `{}`", self.command)?;
        writeln!(f, "- {}", self.machine)?;
        writeln!(f, "- engines in Rust are compiled for {}", self.compiled_for)?;
        writeln!(f, "- load {before} at the beginning, {now} at the end; {}", self.note)
    }
}

/// An argument as a shell takes it.
fn quoted(argument: String) -> String {
    if argument.contains(|c: char| c.is_whitespace() || "'\"$&|;<>()*?`\\".contains(c)) {
        format!("'{}'", argument.replace('\'', "'\\''"))
    } else {
        argument
    }
}

/// The first number of the system's load average, where a file has it.
fn load() -> String {
    let text = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split(' ').next().unwrap_or("unknown").to_owned()
}

/// Serialises rows as CSV, named by their fields.
pub fn csv(rows: &[impl Serialize]) -> miette::Result<String> {
    let mut out = csv::Writer::from_writer(Vec::new());
    for row in rows {
        out.serialize(row).into_diagnostic()?;
    }
    String::from_utf8(out.into_inner().into_diagnostic()?).into_diagnostic()
}

/// Prints rows as CSV, and writes them to `name`.csv in a directory if there is one.
pub fn print_csv(
    rows: &[impl Serialize],
    directory: Option<&Path>,
    name: &str,
) -> miette::Result<()> {
    let text = csv(rows)?;
    print!("{text}");
    let Some(directory) = directory else {
        return Ok(());
    };
    fs::create_dir_all(directory)
        .and_then(|()| sdop::files::write(&directory.join(name).with_extension("csv"), text))
        .into_diagnostic()
        .wrap_err_with(|| format!("writing to {}", directory.display()))
}

/// Writes `name`.csv, .json and .md.
pub fn write(
    directory: &Path,
    name: &str,
    csv: String,
    json: &impl Serialize,
    page: String,
) -> miette::Result<()> {
    let json = serde_json::to_string_pretty(json).into_diagnostic()? + "\n";
    let blame = || format!("writing to {}", directory.display());
    fs::create_dir_all(directory).into_diagnostic().wrap_err_with(blame)?;
    for (ending, text) in [("csv", csv), ("json", json), ("md", page)] {
        sdop::files::write(&directory.join(name).with_extension(ending), text)
            .into_diagnostic()
            .wrap_err_with(blame)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::quoted;

    /// A command can be given to a shell.
    #[test]
    fn command_survives_a_shell() {
        assert_eq!(quoted("--out".to_owned()), "--out");
        assert_eq!(quoted("500,10000".to_owned()), "500,10000");
        assert_eq!(quoted("PhysX ABP".to_owned()), "'PhysX ABP'");
        assert_eq!(quoted("it's".to_owned()), r"'it'\''s'");
    }
}
