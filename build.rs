//! Tells the crate whether it is optimised.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Where nothing is optimised, each vector of an inlined function has a separate place on the
    // stack: the or-DOP test took 10 MB of it, more than a thread has.
    println!("cargo:rustc-check-cfg=cfg(unoptimised)");
    if std::env::var_os("OPT_LEVEL").is_some_and(|level| level == "0") {
        println!("cargo:rustc-cfg=unoptimised");
    }
}
