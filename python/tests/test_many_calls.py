"""Many calls: nothing is left behind, and threads of Python share what they like."""

import threading
import time

import numpy as np
import pytest
import sdop

IDENTITY = (np.float32([0, 0, 0, 1]), np.zeros(3))


def tetrahedron():
    return sdop.Shape([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096


def frames_of_boxes():
    given, culler = np.zeros((3, 6), np.float32), sdop.BoxCuller()
    return lambda: culler.cull(given)


def single_calls():
    given = np.zeros((3, 6), np.float32)
    return lambda: sdop.box_pairs(given)


def frames_of_bodies():
    culler = sdop.Culler([tetrahedron()], [0, 0])
    rotations, translations = np.tile(IDENTITY[0], (2, 1)), np.zeros((2, 3), np.float32)
    return lambda: culler.cull(rotations, translations)


def bodies_that_come_and_go():
    world = sdop.World([tetrahedron()])
    world.insert(0, *IDENTITY)

    def call():
        id = world.insert(0, *IDENTITY)
        world.cull()
        world.events()
        world.remove(id)

    return call


def snapshots():
    world = sdop.BoxWorld()
    world.insert(np.zeros(6))
    return lambda: world.restore(world.snapshot())


def shapes():
    return tetrahedron


def exact_answers():
    shape = tetrahedron()
    return lambda: sdop.exact_meet(shape, IDENTITY, shape, IDENTITY)


def questions():
    world, index = sdop.BoxWorld(), sdop.QueryIndex()
    world.insert(np.zeros(6))

    def call():
        index.update(world)
        index.touching_boxes([[0, 0, 0, 1, 1, 1]])
        index.first([[0, 0, 0]], [[1, 1, 1]])

    return call


def parts():
    compound = sdop.Compound([tetrahedron()], [0], [IDENTITY[0]], [IDENTITY[1]])
    world, culler = sdop.World([compound.shape]), sdop.PartCuller()
    ids = [world.insert(0, *IDENTITY) for _ in range(2)]

    def call():
        culler.set_parts(0, compound)
        world.set_pose(ids[0], *IDENTITY)
        world.cull()
        culler.cull(world)

    return call


def refusals():
    given = np.full((3, 6), np.nan, np.float32)

    def call():
        with pytest.raises(sdop.SdopError):
            sdop.box_pairs(given)

    return call


@pytest.mark.parametrize(
    ("made", "calls"),
    [
        (frames_of_boxes, 100_000),
        (single_calls, 100_000),
        (frames_of_bodies, 100_000),
        (bodies_that_come_and_go, 30_000),
        (snapshots, 20_000),
        (shapes, 20_000),
        (exact_answers, 20_000),
        (questions, 20_000),
        (parts, 20_000),
        (refusals, 20_000),
    ],
)
def test_calls_leave_nothing_behind(made, calls):
    call = made()
    for _ in range(calls // 10):
        call()
    before = resident()
    for _ in range(calls):
        call()
    assert resident() - before < 24 * calls // 10 + 2_000_000


def test_one_object_serves_many_threads():
    """Each thread's calls give what they give alone, whatever the others do meanwhile."""
    draws = np.random.default_rng(6)
    lower = draws.uniform(0, 8, (8, 200, 3)).astype(np.float32)
    frames = np.concatenate([lower, lower + 1], axis=2)
    culler, index, world = sdop.BoxCuller(threads=2), sdop.QueryIndex(), sdop.BoxWorld()
    for box in frames[0]:
        world.insert(box)
    index.update(world)
    wanted = [(sdop.box_pairs(frame, sort=True).tolist(), index.touching_boxes(frame).tolist()) for frame in frames]
    pairs_of_world = world.cull().tolist()
    wrong = []

    def run(which):
        try:
            for _ in range(30):
                index.update(world)
                answers = (culler.cull(frames[which], sort=True).tolist(), index.touching_boxes(frames[which]).tolist())
                if answers != wanted[which] or world.cull().tolist() != pairs_of_world:
                    wrong.append(which)
        except Exception as error:
            wrong.append(error)

    threads = [threading.Thread(target=run, args=(which,)) for which in range(8)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert not wrong


def test_other_threads_run_while_a_frame_is_culled():
    """In at least one of ten frames, another thread never waits for as long as the frame takes."""
    lower = np.random.default_rng(7).uniform(0, 60, (200_000, 3)).astype(np.float32)
    frame = np.hstack([lower, lower + 1])
    longest, is_done = [0.0], threading.Event()

    def watch():
        last = time.perf_counter()
        while not is_done.is_set():
            now = time.perf_counter()
            longest[0], last = max(longest[0], now - last), now

    watcher = threading.Thread(target=watch)
    watcher.start()
    culler, was_free = sdop.BoxCuller(), False
    for _ in range(10):
        time.sleep(0.02)
        longest[0] = 0.0
        culler.cull(frame)
        time.sleep(0.02)
        was_free |= longest[0] < 0.8 * culler.seconds
    is_done.set()
    watcher.join()
    assert was_free
