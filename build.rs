//! Tells the crate whether it is optimised, and which tiers it leaves out.

/// The tiers beside the scalar one, each compiled unless `SDOP_TIERS` omits it.
const TIERS: [&str; 5] = ["scalar-flush", "sse2", "avx2", "avx512", "neon"];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Where nothing is optimised, each vector of an inlined function has a separate place on the
    // stack: the or-DOP test took 10 MB of it, more than a thread has.
    println!("cargo:rustc-check-cfg=cfg(unoptimised)");
    if std::env::var_os("OPT_LEVEL").is_some_and(|level| level == "0") {
        println!("cargo:rustc-cfg=unoptimised");
    }
    // Kernels are compiled once per tier; `SDOP_TIERS=avx2` leaves two of five. For development:
    // the pairs are the same.
    println!("cargo:rerun-if-env-changed=SDOP_TIERS");
    println!("cargo:rustc-check-cfg=cfg(omits, values(none(), \"{}\"))", TIERS.join("\", \""));
    let Ok(wanted) = std::env::var("SDOP_TIERS") else { return };
    let wanted: Vec<&str> = wanted.split(',').filter(|name| !name.is_empty()).collect();
    for name in &wanted {
        assert!(TIERS.contains(name), "SDOP_TIERS: `{name}` is not one of {}", TIERS.join(", "));
    }
    println!("cargo:rustc-cfg=omits");
    for name in TIERS.iter().filter(|name| !wanted.contains(name)) {
        println!("cargo:rustc-cfg=omits=\"{name}\"");
    }
}
