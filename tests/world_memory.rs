//! The memory of worlds, in bytes of the heap, follows what is in them now, also after many shapes
//! have come and gone, crowds, and the events of crowds.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(unsafe_code, reason = "an allocator that counts is an allocator")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::collections::VecDeque;
use std::ops::Range;

use sdop::boxes::BoxBody;
use sdop::mesh::ProceduralShape;
use sdop::settings::{CullSettings, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, World};
use sdop::{Aabb, BoxWorld, Culler, Motion, QueryIndex};

/// The system's allocator, counting the bytes that each thread holds and the most that it held:
/// tests run side by side.
struct Counting;

thread_local! {
    static HELD: Cell<[i64; 2]> = const { Cell::new([0; 2]) };
}

fn count(bytes: i64) {
    HELD.with(|held| {
        let [now, most] = held.get();
        held.set([now + bytes, most.max(now + bytes)]);
    });
}

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as i64);
        // SAFETY: the caller vouches for the layout.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(-(layout.size() as i64));
        // SAFETY: the caller vouches for the memory and its layout.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The bytes that a value holds, made on this thread alone.
fn held<T>(make: impl FnOnce() -> T) -> (T, i64) {
    let before = HELD.with(Cell::get)[0];
    let made = make();
    (made, HELD.with(Cell::get)[0] - before)
}

/// The most bytes that a call takes in addition.
fn most_taken(call: impl FnOnce()) -> i64 {
    let before = HELD.with(|held| {
        let [now, _] = held.get();
        held.set([now; 2]);
        now
    });
    call();
    HELD.with(Cell::get)[1] - before
}

fn form(number: u16) -> Shape {
    let side = |n: u16| 1.0 + f32::from(n % 4) / 4.0;
    let mesh = ProceduralShape::Box { x: side(number), y: side(number / 4), z: side(number / 2) };
    Shape::build(&mesh.build().unwrap(), &ShapeSpec::default()).unwrap()
}

fn world(strategy: Strategy) -> World {
    let settings = CullSettings { strategy, ..CullSettings::default() };
    World::with(Vec::new(), &Culler::builder().settings(&settings)).unwrap()
}

/// Shapes at once, each with three bodies in a row.
const TERRAIN: usize = 40;

/// Adds a shape and three bodies of it, one of them with one of many margins.
fn lay(world: &mut World, forms: &[Shape], step: usize) -> (u32, [BodyId; 3]) {
    let shape = world.add_shape(forms[step % forms.len()].clone()).unwrap();
    let ids = [0, 1, 2].map(|i| {
        let margin = (i / 2) as f32 * 1.0e-3 * (step % 4096) as f32;
        let x = (3 * (step % 1024) + i) as f64;
        let body = Body { margin, ..Body::at(shape, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]) };
        let body = if i == 1 { body.fixed() } else { body };
        world.insert(body).unwrap()
    });
    (shape, ids)
}

/// A world after a stream of shapes, and the steps whose shapes it still holds.
fn streamed(strategy: Strategy, forms: &[Shape], steps: usize) -> (World, Range<usize>) {
    let mut world = world(strategy);
    let mut terrain = VecDeque::new();
    for step in 0..steps {
        if terrain.len() == TERRAIN {
            let (shape, ids) = terrain.pop_front().unwrap();
            for id in ids {
                world.remove(id).unwrap();
            }
            world.remove_shape(shape).unwrap();
        }
        terrain.push_back(lay(&mut world, forms, step));
        world.cull().unwrap();
    }
    // Slots are given again after the cull, so that a stream has as many as bodies of one step
    // more.
    assert!(world.slots() <= 3 * (TERRAIN + 1) && world.shapes().count() == TERRAIN);
    (world, steps - TERRAIN..steps)
}

/// A new world that holds the shapes and bodies of these steps. The last ones come after a cull, so
/// that this world is in use as well: it has the index that serves few changes.
fn fresh(strategy: Strategy, forms: &[Shape], steps: Range<usize>) -> World {
    let mut world = world(strategy);
    let last = steps.end - 1;
    for step in steps {
        if step == last {
            world.cull().unwrap();
        }
        lay(&mut world, forms, step);
    }
    world.cull().unwrap();
    world
}

/// A world's bodies in any order, without the numbers of their shapes.
fn bodies(world: &World) -> Vec<String> {
    let anonymous = |(_, body)| format!("{:?}", Body { shape: 0, ..body });
    let mut bodies: Vec<String> = world.bodies().map(anonymous).collect();
    bodies.sort_unstable();
    bodies
}

/// A world that has streamed shapes holds at most 1.1 times the bytes of a new one with the same
/// shapes and bodies, in use and after both have freed what they can.
#[test]
fn shape_stream_keeps_memory() {
    let forms: Vec<Shape> = (0..48).map(form).collect();
    // World-aligned slabs take a hull of each shape, which takes time: fewer of them.
    for (strategy, steps) in
        [(Strategy::SDopSequential, 100_000), (Strategy::KDop, 3_000), (Strategy::Obb, 1_000)]
    {
        let ((mut long, last), bytes) = held(|| streamed(strategy, &forms, steps));
        let (mut new, wanted) = held(|| fresh(strategy, &forms, last));
        assert_eq!(bodies(&long), bodies(&new));
        assert!(10 * bytes <= 11 * wanted, "{strategy}: {bytes} of {wanted}");
        let shrunk = [&mut long, &mut new].map(|world| held(|| world.shrink_to_fit()).1);
        let [bytes, wanted] = [bytes + shrunk[0], wanted + shrunk[1]];
        assert!(10 * bytes <= 11 * wanted, "{strategy}: {bytes} of {wanted}, shrunk");
        assert!(long.cull().unwrap().len() > TERRAIN);
    }
}

/// Where each of so many bodies is once the crowd has gone.
fn dispersed(body: usize) -> [f32; 3] {
    [body % 50, body / 50 % 50, body / 2500].map(|x| 1.5 * x as f32)
}

/// 1,500 bodies and 1.1 million pairs; 15,000 and 112 million behave alike, and take a gigabyte.
const CROWD: usize = 1500;

/// A crowd of bodies that disperses gives its memory back.
#[test]
fn body_crowd_memory_is_freed() {
    for strategy in
        [Strategy::Sphere, Strategy::SDopSequential, Strategy::SDopBatch, Strategy::Aabb]
    {
        let make = |has_met: bool| {
            let mut world = world(strategy);
            let shape = world.add_shape(form(0)).unwrap();
            let at = |body: usize| dispersed(body).map(|x| f64::from(x) * 2.0);
            let ids: Vec<BodyId> = (0..CROWD)
                .map(|body| if has_met { [0.0; 3] } else { at(body) })
                .map(|place| world.insert(Body::at(shape, [0.0, 0.0, 0.0, 1.0], place)).unwrap())
                .collect();
            for _ in 0..3 {
                let pairs = world.cull().unwrap().len();
                assert_eq!(pairs > CROWD * (CROWD - 1) / 2 - 1, has_met);
                world.events();
            }
            for (body, &id) in ids.iter().enumerate() {
                world.set_pose(id, [0.0, 0.0, 0.0, 1.0], at(body)).unwrap();
            }
            for _ in 0..2 {
                world.cull().unwrap();
                world.events();
            }
            world.shrink_to_fit();
            assert!(world.pair_bytes() <= 100 * CROWD);
            world.cull().unwrap();
            world
        };
        let [(_met, bytes), (_fresh, wanted)] = [true, false].map(|has_met| held(|| make(has_met)));
        assert!(10 * bytes <= 11 * wanted, "{strategy}: {bytes} of {wanted}");
    }
}

fn box_at(place: [f32; 3]) -> Aabb {
    Aabb::new(place, place.map(|x| x + 1.0))
}

/// A crowd of boxes that disperses gives its memory back.
#[test]
fn box_crowd_memory_is_freed() {
    let make = |has_met: bool| {
        let mut world = BoxWorld::new();
        let there = |body| if has_met { [0.0; 3] } else { dispersed(body) };
        let insert = |body| world.insert(box_at(there(body))).unwrap();
        let ids: Vec<BodyId> = (0..CROWD).map(insert).collect();
        for _ in 0..3 {
            world.cull().unwrap();
            world.events();
        }
        for (body, &id) in ids.iter().enumerate() {
            world.set_bounds(id, box_at(dispersed(body))).unwrap();
        }
        for _ in 0..2 {
            world.cull().unwrap();
            world.events();
        }
        world.shrink_to_fit();
        world.cull().unwrap();
        world
    };
    let [(_met, bytes), (_fresh, wanted)] = [true, false].map(|has_met| held(|| make(has_met)));
    assert!(10 * bytes <= 11 * wanted, "{bytes} of {wanted}");
}

/// A world that most bodies have left is small.
#[test]
fn emptied_world_is_small() {
    let few = |many: usize| {
        let mut world = BoxWorld::new();
        let ids: Vec<BodyId> =
            (0..many).map(|body| world.insert(box_at(dispersed(body))).unwrap()).collect();
        world.cull().unwrap();
        for &id in &ids[100..] {
            world.remove(id).unwrap();
        }
        world.cull().unwrap();
        world.shrink_to_fit();
        world.cull().unwrap();
        assert_eq!((world.len(), world.slots()), (100, 100));
        let again = world.insert(box_at([0.0; 3])).unwrap();
        assert!(ids.iter().all(|&id| id != again), "ids are never given again");
        world.remove(again).unwrap();
        world.cull().unwrap();
        world.shrink_to_fit();
        world
    };
    let [(_left, bytes), (_fresh, wanted)] = [20_000, 101].map(|many| held(|| few(many)));
    assert!(10 * bytes <= 11 * wanted, "{bytes} of {wanted}");
    let few = |many: usize| {
        let mut world = world(Strategy::SDopSequential);
        let shape = world.add_shape(form(0)).unwrap();
        let ids: Vec<BodyId> = (0..many)
            .map(|body| Body::at(shape, [0.0, 0.0, 0.0, 1.0], dispersed(body).map(f64::from)))
            .map(|body| world.insert(body).unwrap())
            .collect();
        world.cull().unwrap();
        for &id in &ids[100..] {
            world.remove(id).unwrap();
        }
        world.cull().unwrap();
        world.shrink_to_fit();
        world.cull().unwrap();
        world.shrink_to_fit();
        world
    };
    let [(_left, bytes), (_fresh, wanted)] = [20_000, 101].map(|many| held(|| few(many)));
    assert!(10 * bytes <= 11 * wanted, "{bytes} of {wanted}");
}

/// Bodies that have lived, and which of them are left.
const LIVED: usize = 20_000;
const LEFT: [fn(usize) -> bool; 3] =
    [|body| body + 1 == LIVED, |body| body % 100 == 7, |body| body < 2000];

/// Memory, snapshots and the memory of a frame are those of the bodies that are left, whether there
/// were others or not, without a call to shrink; and bodies may come and go without a cull.
macro_rules! assert_follows_the_living {
    ($new:expr, $insert:expr, $place:expr) => {
        let world = |is_left: fn(usize) -> bool, had_others: bool| {
            let (mut world, mut index) = ($new, QueryIndex::new());
            let bodies = (0..LIVED).filter(|&body| had_others || is_left(body));
            let ids: Vec<(usize, BodyId)> =
                bodies.map(|body| (body, $insert(&mut world, dispersed(body)))).collect();
            index.update(&world);
            world.cull().unwrap();
            for &(body, id) in &ids {
                match is_left(body) {
                    true => $place(&mut world, id, dispersed(body + 1)),
                    false => world.remove(id).unwrap(),
                }
            }
            world.cull().unwrap();
            // A move makes an index of boxes, if there is none.
            let left = ids.iter().find(|&&(body, _)| is_left(body)).unwrap();
            $place(&mut world, left.1, dispersed(left.0));
            world.cull().unwrap();
            index.update(&world);
            assert!(ids.iter().all(|&(body, id)| world.contains(id) == is_left(body)));
            (world, index)
        };
        let text = |snapshot| serde_json::to_string(&snapshot).unwrap().len() as i64;
        for is_left in LEFT {
            let [lived, fresh] = [true, false].map(|had_others| {
                let ((mut world, index), bytes) = held(|| world(is_left, had_others));
                let frame = most_taken(|| {
                    world.cull().unwrap();
                    index.clone().update(&world);
                });
                [bytes, text(world.snapshot()), frame]
            });
            assert!(lived[0] <= 2 * fresh[0] + (64 << 10), "{lived:?}, {fresh:?}");
            assert!(10 * lived[1] <= 11 * fresh[1] + (40 << 10), "{lived:?}, {fresh:?}");
            assert!(lived[2] <= 2 * fresh[2] + (4 << 10), "{lived:?}, {fresh:?}");
        }
        let (mut world, mut index) = ($new, QueryIndex::new());
        let (_, bytes) = held(|| {
            let mut all = VecDeque::new();
            for body in 0..30_000 {
                all.push_back($insert(&mut world, dispersed(body % 1000)));
                if all.len() > 50 {
                    world.remove(all.pop_front().unwrap()).unwrap();
                }
            }
            index.update(&world);
        });
        assert!(index.len() == 50 && bytes < 96 << 10, "{bytes}");
        assert!(text(world.snapshot()) < 24 << 10);
    };
}

/// A world that most bodies have left is as small as one that never had them.
#[test]
fn lived_worlds_follow_the_living() {
    assert_follows_the_living!(
        BoxWorld::new(),
        |world: &mut BoxWorld, place| world.insert(box_at(place)).unwrap(),
        |world: &mut BoxWorld, id, place| world.set_bounds(id, box_at(place)).unwrap()
    );
    let there = |place: [f32; 3]| place.map(|x| 2.0 * f64::from(x));
    const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
    assert_follows_the_living!(
        World::new(vec![form(0)]).unwrap(),
        |world: &mut World, place| world.insert(Body::at(0, UNTURNED, there(place))).unwrap(),
        |world: &mut World, id, place| world.set_pose(id, UNTURNED, there(place)).unwrap()
    );
}

/// After a bulk load, and after a world was restored, a frame in which one body moves allocates
/// nothing that grows with the world.
#[test]
fn first_moves_are_no_hitch() {
    let mut world = BoxWorld::new();
    let mut ids = Vec::new();
    for body in 0..LIVED {
        let motion = if body % 100 == 0 { Motion::Dynamic } else { Motion::Fixed };
        let bounds = box_at(dispersed(body));
        ids.push(world.insert(BoxBody { motion, ..bounds.into() }).unwrap());
    }
    let mut meshes = World::new(vec![form(0)]).unwrap();
    let there = |body| dispersed(body).map(|x| 2.0 * f64::from(x));
    let body = |body| Body::at(0, [0.0, 0.0, 0.0, 1.0], there(body));
    let bodies: Vec<BodyId> = (0..2000).map(|i| meshes.insert(body(i)).unwrap()).collect();
    world.cull().unwrap();
    meshes.cull().unwrap();
    for step in 0..4 {
        world.set_bounds(ids[100 * step], box_at(dispersed(step + 1))).unwrap();
        let taken = most_taken(|| _ = world.cull().unwrap());
        assert!(taken < 64 << 10, "step {step}: {taken}");
        meshes.set_pose(bodies[step], [0.0, 0.0, 0.0, 1.0], there(step + 7)).unwrap();
        let taken = most_taken(|| _ = meshes.cull().unwrap());
        assert!(taken < 64 << 10, "step {step}: {taken}");
        assert_eq!(world.rest_counters().queried, meshes.counters().rest.queried);
        assert_eq!(world.rest_counters().queried, step as u64 + 1);
        let (saved, other) = (world.snapshot(), meshes.snapshot());
        world.restore(&saved).unwrap();
        meshes.restore(&other).unwrap();
    }
}

/// Events are read off two lists: no third is kept, and bodies may be removed meanwhile.
#[test]
fn crowd_events_need_no_list() {
    let mut world = BoxWorld::new();
    for body in 0..CROWD {
        let bounds = box_at([0.0; 3]);
        let motion = if body == 7 { Motion::Fixed } else { Motion::Dynamic };
        let groups = sdop::Groups::ALL;
        world.insert(BoxBody { bounds, motion, groups }).unwrap();
    }
    let pairs = CROWD * (CROWD - 1) / 2;
    assert_eq!(world.cull().unwrap().iter().count(), pairs); // sorted when they are first read
    let taken = most_taken(|| {
        assert_eq!(world.events().begun().count(), pairs);
        let events = world.events();
        assert_eq!(events.persisting().count(), pairs);
        for [_, second] in events.persisting().take(CROWD - 1) {
            world.remove(second).unwrap();
        }
        assert_eq!((world.len(), events.iter().count()), (1, pairs));
    });
    assert!(taken < 100 * CROWD as i64, "{taken}");
    assert!(world.cull().unwrap().is_empty());
    assert_eq!(world.events().ended().count(), pairs);
}
