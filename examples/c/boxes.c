/* Boxes of an engine in, pairs that meet out; then a world in which they come and go, and which is
   asked what is where; then a cell that repeats. C11. */
#undef NDEBUG /* what is asserted is shown */
#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "sdop.h"

static void check(SdopStatus status) {
    if (status != SDOP_STATUS_OK) {
        fprintf(stderr, "%s\n", sdop_last_error());
        exit(1);
    }
}

static void print_event(void *user, SdopEvent event) {
    const char *const kinds[] = {"begun", "persisting", "ended"};
    printf("%s: %" PRIx64 " and %" PRIx64 "\n", kinds[event.kind], event.pair.first, event.pair.second);
    ++*(int *)user;
}

/* Which boxes are near a point, and which does a segment meet? */
static void ask(const SdopBoxWorld *world, uint64_t near, uint64_t far) {
    SdopQueryIndex *index;
    check(sdop_query_index_new(&index));
    check(sdop_query_index_update_boxes(index, world)); /* again after boxes have moved */

    const double centre[3] = {3, 0.5, 0.5};
    uint64_t found[2];
    size_t count;
    check(sdop_query_index_touching_ball(index, &centre, 2, found, 2, &count));
    assert(count == 1 && found[0] == near);

    const SdopSegment sight = {{9, 9, 9}, {-1, -1, -1}};
    SdopHit hits[2];
    bool is_hit;
    check(sdop_query_index_first(index, &sight, hits, &is_hit));
    assert(is_hit && hits[0].id == far);
    printf("seen first: %" PRIx64 " at %.3f of the way\n", hits[0].id, hits[0].at);
    check(sdop_query_index_along(index, &sight, hits, 2, &count));
    assert(count == 2 && hits[0].id == far && hits[1].id == near && hits[0].at < hits[1].at);
    sdop_query_index_free(index);
}

/* Writes an event to where `user` points. */
static void take_last(void *user, SdopPeriodicEvent event) { *(SdopPeriodicEvent *)user = event; }

/* A cell that repeats along x and y: which boxes meet, and in which image? */
static void periodic_cell(void) {
    const double cell[3] = {10, 10, 0}; /* z has no period */
    SdopPeriodicBoxes *world;
    check(sdop_periodic_boxes_new(&cell, NULL, 1, &world));
    SdopPeriodicBox boxes[] = {
        sdop_periodic_box_between(0, 4, 0, 1, 5, 1),
        sdop_periodic_box_between(9, 4.5, 0.5, 10, 5.5, 1.5),
    };
    uint64_t ids[2];
    for (size_t i = 0; i < 2; ++i) check(sdop_periodic_boxes_insert(world, &boxes[i], &ids[i]));
    size_t count;
    check(sdop_periodic_boxes_cull(world, &count));
    SdopPeriodicPair pair;
    check(sdop_periodic_boxes_pairs(world, &pair, 1, &count));
    assert(count == 1 && pair.bodies.first == ids[0] && pair.bodies.second == ids[1]);
    assert(pair.image[0] == -1 && pair.image[1] == 0 && pair.image[2] == 0);
    printf("the second box meets the first, moved by %" PRId32 " periods along x\n", pair.image[0]);
    SdopPeriodicEvent event;
    check(sdop_periodic_boxes_events(world, take_last, &event));
    assert(event.kind == SDOP_EVENT_KIND_BEGUN && event.pair.image[0] == -1);

    boxes[1].min[0] = 8.5;
    boxes[1].max[0] = 9.5;
    check(sdop_periodic_boxes_set(world, ids, boxes, 2)); /* in each step */
    check(sdop_periodic_boxes_cull(world, &count));
    assert(count == 0);
    check(sdop_periodic_boxes_events(world, take_last, &event));
    assert(event.kind == SDOP_EVENT_KIND_ENDED && event.pair.image[0] == -1);
    boxes[1].max[0] = 13.5;
    assert(sdop_periodic_boxes_set(world, &ids[1], &boxes[1], 1) == SDOP_STATUS_REFUSED);
    printf("%s\n", sdop_last_error());
    sdop_periodic_boxes_free(world);
}

int main(void) {
    const SdopBox boxes[] = {
        {{0, 0, 0}, {1, 1, 1}},
        {{1, 0, 0}, {2, 1, 1}}, /* touches the first: touching is meeting */
        {{5, 5, 5}, {6, 6, 6}},
    };
    const size_t count = sizeof boxes / sizeof *boxes;

    SdopBoxCuller *culler;
    check(sdop_box_culler_new(NULL, 1, &culler));
    size_t found;
    check(sdop_box_culler_cull(culler, boxes, NULL, count, &found));
    SdopPair *pairs = malloc((found + 1) * sizeof *pairs);
    check(sdop_box_culler_pairs(culler, pairs, found, &found));
    for (size_t i = 0; i < found; ++i) printf("boxes %u and %u meet\n", pairs[i].first, pairs[i].second);
    assert(found == 1 && pairs[0].first == 0 && pairs[0].second == 1);
    free(pairs);
    sdop_box_culler_free(culler);

    SdopBoxWorld *world;
    check(sdop_box_world_new(NULL, 1, &world));
    uint64_t ids[3];
    for (size_t i = 0; i < count; ++i) {
        const SdopBoxBody body = sdop_box_body_at(boxes[i]);
        check(sdop_box_world_insert(world, &body, &ids[i]));
    }
    int events = 0;
    check(sdop_box_world_cull(world, &found));
    check(sdop_box_world_events(world, print_event, &events));
    check(sdop_box_world_remove(world, ids[1]));
    check(sdop_box_world_cull(world, &found));
    check(sdop_box_world_events(world, print_event, &events));
    assert(found == 0 && events == 2);
    ask(world, ids[0], ids[2]);

    /* What is refused says how to mend it. */
    const SdopBox inside_out = {{1, 0, 0}, {0, 1, 1}};
    const SdopStatus status = sdop_box_world_set_bounds(world, &ids[0], &inside_out, 1);
    assert(status == SDOP_STATUS_REFUSED);
    printf("%s\n", sdop_last_error());
    sdop_box_world_free(world);
    periodic_cell();
    return 0;
}
