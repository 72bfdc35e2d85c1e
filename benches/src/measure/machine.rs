//! The machine of a measurement, as far as it explains times, without names or paths.

use serde::{Deserialize, Serialize};

use sdop::simd::Tier;

/// The description of a measurement's machine.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Machine {
    /// The CPU's name; ids tell models of one name apart.
    pub cpu: String,
    /// Threads that may run at once.
    pub cores: usize,
    /// System, release and architecture.
    pub os: String,
    /// The compiler that built this crate.
    pub rustc: String,
    /// This crate's version.
    pub version: String,
    /// The tier that culled.
    pub simd: String,
    /// Whether debug assertions were off.
    pub optimised: bool,
}

impl Machine {
    /// This machine, culling in the tier `tier`.
    #[must_use]
    pub fn here(tier: Tier) -> Self {
        Self {
            cpu: cpu().unwrap_or_else(|| format!("unknown ({})", std::env::consts::ARCH)),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            os: format!("{} {}", os(), std::env::consts::ARCH),
            rustc: env!("SDOP_RUSTC").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            simd: tier.name().to_owned(),
            optimised: !cfg!(debug_assertions),
        }
    }
}

impl std::fmt::Display for Machine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}, {} cores, {}, {}; sdop {}, {}",
            self.cpu, self.cores, self.os, self.simd, self.version, self.rustc
        )?;
        if self.optimised { Ok(()) } else { f.write_str(", a build with debug assertions") }
    }
}

/// The CPU's name, where the system has it in a file; ids tell models of one name apart.
fn cpu() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let value = |key: &str| {
        let line = text.lines().find(|line| line.split(':').next().map(str::trim) == Some(key))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let name = value("model name")?;
    let ids = ["cpu family", "model"].map(|key| value(key).unwrap_or_default());
    Some(format!("{name} (family {}, model {})", ids[0], ids[1]))
}

/// The data caches of the first core, where Linux describes them: the level and the size of each,
/// as in `48K`.
#[must_use]
pub fn caches() -> Vec<(usize, String)> {
    let read = |index: usize, what: &str| {
        let path = format!("/sys/devices/system/cpu/cpu0/cache/index{index}/{what}");
        Some(std::fs::read_to_string(path).ok()?.trim().to_owned())
    };
    let cache = |index| {
        let level = read(index, "level")?.parse().ok()?;
        Some((read(index, "type")?, (level, read(index, "size")?)))
    };
    let caches = (0..8).map_while(cache).filter(|(kind, _)| kind != "Instruction");
    caches.map(|(_, cache)| cache).collect()
}

/// The system and its release, as far as a file says.
fn os() -> String {
    let kernel = std::fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    let release: String = kernel.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    format!("{} {}", std::env::consts::OS, release.trim_matches('.')).trim().to_owned()
}
