// Meshes with poses of an engine: a fixed set, a world with margins that is saved and rolled back,
// a world that repeats, queries, bodies of several shapes, single pairs. C++17.
#undef NDEBUG // what is asserted is shown
#include <array>
#include <cassert>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "sdop.h"

namespace {

void check(SdopStatus status) {
    if (status != SDOP_STATUS_OK) throw std::runtime_error(sdop_last_error());
}

template <typename T, void (*FREE)(T *)>
struct Free {
    void operator()(T *handle) const { FREE(handle); }
};
using Shape = std::unique_ptr<SdopShape, Free<SdopShape, sdop_shape_free>>;
using Culler = std::unique_ptr<SdopCuller, Free<SdopCuller, sdop_culler_free>>;
using Compound = std::unique_ptr<SdopCompound, Free<SdopCompound, sdop_compound_free>>;
using Index = std::unique_ptr<SdopQueryIndex, Free<SdopQueryIndex, sdop_query_index_free>>;
using PairTest = std::unique_ptr<SdopPairTest, Free<SdopPairTest, sdop_pair_test_free>>;
using PartCuller = std::unique_ptr<SdopPartCuller, Free<SdopPartCuller, sdop_part_culler_free>>;
using PeriodicWorld = std::unique_ptr<SdopPeriodicWorld, Free<SdopPeriodicWorld, sdop_periodic_world_free>>;
using World = std::unique_ptr<SdopWorld, Free<SdopWorld, sdop_world_free>>;

Shape tetrahedron() {
    const double vertices[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::uint32_t triangles[][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    SdopShape *shape = nullptr;
    check(sdop_shape_new(vertices, 4, triangles, 4, nullptr, &shape));
    return Shape(shape);
}

std::vector<SdopIdPair> pairs_of(SdopWorld *world) {
    std::size_t count = 0;
    check(sdop_world_cull(world, &count));
    std::vector<SdopIdPair> pairs(count);
    check(sdop_world_pairs(world, pairs.data(), pairs.size(), &count));
    return pairs;
}

void a_fixed_set(const SdopShape *shape) {
    const std::uint32_t shapes[] = {0, 0, 0};
    const float rotations[][4] = {{0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}};
    float translations[][3] = {{0, 0, 0}, {0.5F, 0, 0}, {9, 0, 0}};
    SdopBodies bodies{};
    bodies.count = 3;
    bodies.shape = shapes;
    bodies.rotation = rotations;
    bodies.translation = translations;
    SdopCuller *made = nullptr;
    check(sdop_culler_new(&shape, 1, &bodies, nullptr, &made));
    const Culler culler(made);
    std::size_t count = 0;
    check(sdop_culler_cull(culler.get(), rotations, translations, &count));
    assert(count == 1);
    translations[2][0] = 1; // touches the second's corner
    check(sdop_culler_cull(culler.get(), rotations, translations, &count));
    assert(count == 3);
    std::array<SdopPair, 3> pairs{};
    assert(sdop_culler_pairs(culler.get(), pairs.data(), 1, &count) == SDOP_STATUS_TOO_SMALL && count == 3);
    check(sdop_culler_pairs(culler.get(), pairs.data(), pairs.size(), &count));
    for (const auto &[first, second] : pairs) std::printf("%u and %u might touch\n", first, second);
}

void a_world(const SdopShape *shape) {
    SdopWorld *made = nullptr;
    check(sdop_world_new(&shape, 1, nullptr, &made));
    const World world(made);
    std::array<std::uint64_t, 2> ids{};
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const SdopBody body = sdop_body_at(0, 1000000031.5 + 0.7 * static_cast<double>(i), 0, 0);
        check(sdop_world_insert(world.get(), &body, &ids[i]));
    }
    assert(pairs_of(world.get()).size() == 1); // they overlap by 0.3, a billion units from the origin

    std::size_t bytes = 0;
    sdop_world_snapshot(world.get(), nullptr, 0, &bytes);
    std::vector<std::uint8_t> saved(bytes);
    check(sdop_world_snapshot(world.get(), saved.data(), saved.size(), &bytes));

    const float rotation[][4] = {{0, 0, 0, 1}};
    const double far_away[][3] = {{0, 0, 0}};
    check(sdop_world_set_poses(world.get(), &ids[1], rotation, far_away, 1));
    assert(pairs_of(world.get()).empty());
    check(sdop_world_restore(world.get(), saved.data(), saved.size()));
    assert(pairs_of(world.get()).size() == 1);

    check(sdop_world_exclude(world.get(), ids[0], ids[1])); // a joint connects them
    assert(pairs_of(world.get()).empty());
    check(sdop_world_include(world.get(), ids[1], ids[0]));
    assert(pairs_of(world.get()).size() == 1);
    SdopBody asleep = sdop_body_at(0, 1000000031.5, 0, 0);
    asleep.resting = true;
    asleep.groups = SdopGroups_ALL; // as it was
    check(sdop_world_set(world.get(), ids[0], &asleep));
    assert(pairs_of(world.get()).size() == 1);
    assert(sdop_world_exclude(world.get(), ids[0], ids[0] + 1000) == SDOP_STATUS_REFUSED);
}

// Two bodies that touch across the border of a cell, in the one image in which they do.
void a_world_that_repeats(const SdopShape *shape) {
    const double cell[] = {8, 0, 0};
    SdopPeriodicWorld *made = nullptr;
    check(sdop_periodic_world_new(&shape, 1, &cell, nullptr, &made));
    const PeriodicWorld world(made);
    std::array<SdopBody, 2> bodies{sdop_body_at(0, 0, 0, 0), sdop_body_at(0, 8e6 + 7, 0, 0)};
    std::array<std::uint64_t, 2> ids{};
    for (std::size_t i = 0; i < ids.size(); ++i) check(sdop_periodic_world_insert(world.get(), &bodies[i], &ids[i]));
    std::size_t count = 0;
    const auto culled = [&] {
        check(sdop_periodic_world_cull(world.get(), &count));
        return count;
    };
    assert(culled() == 1);
    SdopPeriodicPair pair{};
    check(sdop_periodic_world_pairs(world.get(), &pair, 1, &count));
    assert(pair.bodies.first == ids[0] && pair.bodies.second == ids[1] && pair.image[0] == -1000001);

    check(sdop_periodic_world_exclude(world.get(), ids[0], ids[1]));
    assert(culled() == 0);
    check(sdop_periodic_world_include(world.get(), ids[0], ids[1]));
    bodies[1].translation[0] = 8e6 + 6;
    check(sdop_periodic_world_set(world.get(), ids.data(), bodies.data(), bodies.size()));
    assert(culled() == 0);
    const double smaller[] = {7, 0, 0}, narrow[] = {1, 0, 0};
    assert(sdop_periodic_world_set_periods(world.get(), &narrow) == SDOP_STATUS_REFUSED);
    check(sdop_periodic_world_set_periods(world.get(), &smaller));
    check(sdop_periodic_world_remove(world.get(), ids[1]));
    assert(culled() == 0);
    assert(sdop_periodic_world_set(world.get(), &ids[1], &bodies[1], 1) == SDOP_STATUS_REFUSED);
}

// Boxes and rotations in double: no pair is lost by what floats make of them.
void numbers_in_double(const SdopShape *shape) {
    const double given[][6] = {{0, 0, 0, 0.1, 1, 1}, {0.1, 0, 0, 1, 1, 1}};
    std::array<SdopBox, 2> boxes{};
    check(sdop_boxes_outward(given, boxes.size(), boxes.data()));
    assert(static_cast<double>(boxes[0].max[0]) > 0.1 && static_cast<double>(boxes[1].min[0]) < 0.1);

    SdopWorld *made = nullptr;
    check(sdop_world_new(&shape, 1, nullptr, &made));
    const World world(made);
    const SdopBody body = sdop_body_turned(sdop_body_at(0, 0, 0, 0), 0, 0, 0.6, 0.8);
    assert(body.rounded && !sdop_body_turned(body, 0, 0, 0.75, 1).rounded);
    std::array<std::uint64_t, 2> ids{};
    for (auto &id : ids) check(sdop_world_insert(world.get(), &body, &id));
    const double rotation[][4] = {{0, 0, 0.8, 0.6}}, place[][3] = {{0.1, 0, 0}};
    check(sdop_world_set_poses_f64(world.get(), &ids[1], rotation, place, 1));
    assert(pairs_of(world.get()).size() == 1);
    assert(sdop_part_turned(SdopPart{}, 0, 0, 0.6, 0.8).rounded);
}

// An arm of three links next to a post: which link may touch it?
void parts_of_bodies(const SdopShape *link) {
    std::array<SdopPart, 3> parts{};
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = {0, {0, 0, 0, 1}, {1.5 * static_cast<double>(i), 0, 0}, false};
    SdopCompound *arm_made = nullptr;
    check(sdop_compound_new("arm", &link, 1, parts.data(), parts.size(), &arm_made));
    const Compound arm(arm_made);
    SdopShape *whole = nullptr;
    check(sdop_compound_shape(arm.get(), &whole));
    const Shape arm_shape(whole);

    const SdopShape *const shapes[] = {whole, link};
    SdopWorld *made = nullptr;
    check(sdop_world_new(shapes, 2, nullptr, &made));
    const World world(made);
    const SdopBody robot = sdop_body_at(0, 0, 0, 0);
    SdopBody post = sdop_body_at(1, 3.25, 0.25, 0);
    post.fixed = true;
    std::uint64_t robot_id = 0, post_id = 0;
    check(sdop_world_insert(world.get(), &robot, &robot_id));
    check(sdop_world_insert(world.get(), &post, &post_id));
    assert(pairs_of(world.get()).size() == 1);

    SdopPartCuller *culler_made = nullptr;
    check(sdop_part_culler_new(&culler_made));
    const PartCuller culler(culler_made);
    check(sdop_part_culler_set_parts(culler.get(), 0, arm.get())); // shape 0 of the world has these parts
    std::size_t count = 0;
    check(sdop_part_culler_cull(culler.get(), world.get(), &count));
    SdopPartPair pair{};
    check(sdop_part_culler_pairs(culler.get(), &pair, 1, &count));
    assert(count == 1 && pair.bodies.first == robot_id && pair.bodies.second == post_id);
    assert(pair.first_part == 2 && pair.second_part == 0);
    std::printf("link %u might touch the post\n", pair.first_part);
    SdopIdPair bodies{};
    check(sdop_part_culler_body_pairs(culler.get(), &bodies, 1, &count));
    assert(count == 1 && bodies.first == robot_id);
    check(sdop_part_culler_set_parts(culler.get(), 1, arm.get())); // shape 1 has none
    assert(sdop_part_culler_cull(culler.get(), world.get(), &count) == SDOP_STATUS_REFUSED);
    check(sdop_part_culler_set_parts(culler.get(), 1, nullptr));
    check(sdop_part_culler_cull(culler.get(), world.get(), &count));
}

// What is near, and what is in the line of sight?
void queries(const SdopShape *shape) {
    SdopWorld *made = nullptr;
    check(sdop_world_new(&shape, 1, nullptr, &made));
    const World world(made);
    std::array<std::uint64_t, 3> ids{};
    for (std::size_t i = 0; i < ids.size(); ++i) {
        SdopBody body = sdop_body_at(0, 1e9 + 4.0 * static_cast<double>(i), 0, 0);
        body.margin = 0.25F;
        check(sdop_world_insert(world.get(), &body, &ids[i]));
    }
    SdopQueryIndex *index_made = nullptr;
    check(sdop_query_index_new(&index_made));
    const Index index(index_made);
    check(sdop_query_index_update(index.get(), world.get()));

    const double low[] = {1e9 + 1, 0, 0}, high[] = {1e9 + 3.75, 1, 1}, inside_out[] = {1e9, 0, 0};
    std::array<std::uint64_t, 2> found{};
    std::size_t count = 0;
    check(sdop_query_index_touching_box(index.get(), &low, &high, found.data(), found.size(), &count));
    assert(count == 2 && found[0] == ids[0] && found[1] == ids[1]); // margins reach into it
    assert(sdop_query_index_touching_box(index.get(), &low, &high, found.data(), 1, &count) == SDOP_STATUS_TOO_SMALL);
    assert(sdop_query_index_touching_box(index.get(), &low, &inside_out, nullptr, 0, &count) == SDOP_STATUS_REFUSED);

    const SdopSegment sight{{1e9 + 100, 0.25, 0.25}, {1e9 + 2, 0.25, 0.25}};
    SdopHit hit{};
    bool is_hit = false;
    check(sdop_query_index_first(index.get(), &sight, &hit, &is_hit));
    assert(is_hit && hit.id == ids[2] && hit.at > 0.8 && hit.at < 0.95);
    const SdopSegment upward{{1e9, 0, 5}, {1e9, 0, 9}};
    check(sdop_query_index_first(index.get(), &upward, nullptr, &is_hit));
    assert(!is_hit);
}

void single_pairs(const SdopShape *shape) {
    SdopPairTest *made = nullptr;
    assert(sdop_pair_test_new(17, &made) == SDOP_STATUS_REFUSED);
    check(sdop_pair_test_new(0, &made));
    const PairTest test(made);
    std::uint32_t plain = 0, grown = 0;
    check(sdop_pair_test_add(test.get(), shape, &plain));
    check(sdop_pair_test_grow(test.get(), plain, 2.5F, &grown));
    assert(sdop_pair_test_grow(test.get(), 7, 0.5F, &grown) == SDOP_STATUS_REFUSED && grown == 1);
    const float rotation[] = {0, 0, 0, 1}, touching[] = {1, 0, 0}, apart[] = {3, 0, 0};
    assert(sdop_pair_test_may_touch(test.get(), plain, plain, &rotation, &touching));
    assert(!sdop_pair_test_may_touch(test.get(), plain, plain, &rotation, &apart));
    assert(sdop_pair_test_may_touch(test.get(), grown, plain, &rotation, &apart));
    assert(sdop_pair_test_may_touch(test.get(), 7, plain, &rotation, &apart)); // unknown numbers are never rejected
}

} // namespace

int main() {
    const Shape shape = tetrahedron();
    a_fixed_set(shape.get());
    a_world(shape.get());
    a_world_that_repeats(shape.get());
    queries(shape.get());
    parts_of_bodies(shape.get());
    single_pairs(shape.get());
    numbers_in_double(shape.get());
    std::puts("all as expected");
}
