//! The filter's functions for C++: `native/culling.h` declares them.

#![allow(unsafe_code, reason = "the other side is C++")]

use std::slice::from_raw_parts;

use sdop::mesh::TriangleMesh;
use sdop::volume::{DirectionSet, Shape, ShapeSpec};
use sdop::world::PairTest;

/// No tests yet.
#[unsafe(no_mangle)]
extern "C" fn sdop_test_new() -> *mut PairTest {
    Box::into_raw(Box::new(PairTest::new(DirectionSet::K18)))
}

/// # Safety
/// `test` comes from [`sdop_test_new`] and isn't used afterwards.
#[unsafe(no_mangle)]
unsafe extern "C" fn sdop_test_free(test: *mut PairTest) {
    // SAFETY: made by `Box::into_raw`, and freed once, as the caller promises.
    drop(unsafe { Box::from_raw(test) });
}

/// # Safety
/// `test` comes from [`sdop_test_new`] and nothing else uses it now; three floats a vertex and
/// three indices a triangle follow the pointers.
#[unsafe(no_mangle)]
unsafe extern "C" fn sdop_test_add(
    test: *mut PairTest,
    vertices: *const [f32; 3],
    vertex_count: usize,
    triangles: *const [u32; 3],
    triangle_count: usize,
    margin: f32,
) -> u32 {
    // SAFETY: as many as the caller says.
    let (vertices, triangles) = unsafe {
        (
            from_raw_parts(vertices, vertex_count),
            from_raw_parts(triangles, triangle_count),
        )
    };
    // SAFETY: the caller's own test, which nothing else uses now.
    let test = unsafe { &mut *test };
    add(test, vertices, triangles, margin).unwrap_or(u32::MAX)
}

/// The mesh as it is, about its own origin, and grown; the first's number.
pub fn add(
    test: &mut PairTest,
    vertices: &[[f32; 3]],
    triangles: &[[u32; 3]],
    margin: f32,
) -> Option<u32> {
    let mesh = TriangleMesh::from_f32(vertices, triangles)
        .ok()?
        .named("body");
    let shape = Shape::build(&mesh, &ShapeSpec::default()).ok()?;
    let number = test.add(&shape).ok()?;
    test.grown(number, margin).ok().map(|_| number)
}

/// # Safety
/// `test` comes from [`sdop_test_new`]; four floats of a quaternion and three of a translation
/// follow the pointers.
#[unsafe(no_mangle)]
unsafe extern "C" fn sdop_test_may_touch(
    test: *const PairTest,
    first: u32,
    second: u32,
    rotation: *const [f32; 4],
    translation: *const [f32; 3],
) -> bool {
    // SAFETY: as the caller promises.
    let (test, rotation, translation) = unsafe { (&*test, *rotation, *translation) };
    test.may_touch(first, second, rotation, translation)
}
