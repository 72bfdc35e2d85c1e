//! Compiles the shims of the engines that are C++ libraries of the system.

fn main() {
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
