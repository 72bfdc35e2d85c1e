//! Compiles the scene and the culling dispatcher against the system's Bullet.

fn main() {
    println!("cargo:rerun-if-changed=native");
    println!("cargo:rerun-if-changed=../../../examples/bullet/native/culling.h");
    println!("cargo:rerun-if-changed=../../../src/c/sdop.h");
    #[cfg(feature = "debian")]
    compile();
}

#[cfg(feature = "debian")]
fn compile() {
    cc::Build::new()
        .cpp(true)
        .std("c++17")
        .opt_level(3)
        .define("NDEBUG", None)
        .flag("-isystem/usr/include/bullet") // its headers warn
        .include("../../../src/c")
        .include("../../../examples/bullet/native")
        .file("native/scene.cpp")
        .compile("sdop_bullet_scene");
    for library in ["BulletDynamics", "BulletCollision", "LinearMath"] {
        println!("cargo:rustc-link-lib={library}");
    }
}
