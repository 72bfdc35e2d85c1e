//! Compiles the shims of the engines that are C++ libraries of the system, and names the profile.

fn main() {
    // …/PROFILE/build/PACKAGE/out. In other profiles cargo doesn't optimise the engines.
    let out = std::path::PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    let profile = out.ancestors().nth(3).and_then(|folder| folder.file_name()).unwrap_or_default();
    println!("cargo:rustc-env=SDOP_PROFILE={}", profile.display());
    println!("cargo:rerun-if-changed=native");
    #[cfg(feature = "debian")]
    compile_shims();
}

#[cfg(feature = "debian")]
fn compile_shims() {
    cc::Build::new()
        .cpp(true)
        .std("c++17")
        .opt_level(3)
        .define("NDEBUG", None)
        .include("/usr/include/bullet")
        .files(["embree", "bullet"].map(|name| format!("native/{name}.cpp")))
        .compile("sdop_field");
    for library in ["embree3", "BulletCollision", "LinearMath"] {
        println!("cargo:rustc-link-lib={library}");
    }
}
