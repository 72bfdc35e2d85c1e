/* Many calls from several threads leave nothing behind, give what one call gives, and keep each
   thread's errors apart. Takes the number of rounds, of 404 calls in all. C11, glibc. */
#define _POSIX_C_SOURCE 200112L /* barriers */
#undef NDEBUG
#include <assert.h>
#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sdop.h"

enum { BOXES = 24, BODIES = 6, THREADS = 4 };

static const float IDENTITY[4] = {0, 0, 0, 1};

/* What all threads read at the same time. */
static SdopShape *shape;
static SdopCompound *compound;
static SdopQueryIndex *index_of_boxes;
static SdopPairTest *pair_test;
static pthread_barrier_t all_have_called; /* so that the C library keeps as many heaps each time */

typedef struct {
    int number;
    long rounds, calls;
    size_t pairs; /* of the first round */
} Caller;

static void check(Caller *caller, SdopStatus status) {
    ++caller->calls;
    if (status == SDOP_STATUS_OK) return;
    fprintf(stderr, "%s\n", sdop_last_error());
    exit(1);
}

/* A call that is refused, with a text that has these words. */
static void refused(Caller *caller, SdopStatus status, const char *words) {
    ++caller->calls;
    assert(status != SDOP_STATUS_OK && status != SDOP_STATUS_BUG && strstr(sdop_last_error(), words));
}

static SdopBox box(int i) {
    const float x = (float)(i * 7 % 13), y = (float)(i * 5 % 11), z = (float)(i * 3 % 5);
    return (SdopBox){{x, y, z}, {x + 2, y + 2, z + 2}};
}

static void count_pairs(void *sum, const SdopPair *pairs, size_t count) {
    (void)pairs;
    *(size_t *)sum += count;
}

static void count_id_pairs(void *sum, const SdopIdPair *pairs, size_t count) {
    (void)pairs;
    *(size_t *)sum += count;
}

static void count_event(void *sum, SdopEvent event) {
    *(size_t *)sum += event.kind == SDOP_EVENT_KIND_BEGUN;
}

static size_t frames_of_boxes(Caller *it) {
    SdopBox boxes[BOXES];
    for (int i = 0; i < BOXES; ++i) boxes[i] = box(i);
    SdopBoxCuller *culler;
    check(it, sdop_box_culler_new(NULL, 1, &culler));
    size_t found, copied, summed = 0;
    check(it, sdop_box_culler_cull(culler, boxes, NULL, BOXES, &found));
    SdopPair pairs[BOXES * BOXES];
    check(it, sdop_box_culler_pairs(culler, pairs, BOXES * BOXES, &copied));
    refused(it, sdop_box_culler_pairs(culler, pairs, 1, &copied), "larger buffer");
    refused(it, sdop_box_culler_cull_each(culler, boxes, NULL, BOXES, NULL, &summed), "take is null");
    check(it, sdop_box_culler_cull_each(culler, boxes, NULL, BOXES, count_pairs, &summed));
    assert(copied == found && summed == found);
    refused(it, sdop_box_culler_cull_up_to(culler, boxes, NULL, BOXES, found - 1, &copied), "are allowed");
    check(it, sdop_box_culler_cull_up_to(culler, boxes, NULL, BOXES, found, &copied));
    boxes[3].min[1] = 1e9F;
    refused(it, sdop_box_culler_cull(culler, boxes, NULL, BOXES, &found), "3");
    refused(it, sdop_box_culler_cull(culler, NULL, NULL, BOXES, &found), "boxes is null");
    sdop_box_culler_free(culler);
    char finder[32];
    snprintf(finder, sizeof finder, "finder-%d", it->number);
    refused(it, sdop_box_culler_new(finder, 1, &culler), finder);
    refused(it, sdop_box_culler_new(NULL, 1, NULL), "out is null");
    return summed;
}

static size_t world_of_boxes(Caller *it) {
    SdopBoxWorld *world;
    check(it, sdop_box_world_new(NULL, 1, &world));
    uint64_t ids[BOXES];
    const SdopBoxBody first = sdop_box_body_at(box(0));
    refused(it, sdop_box_world_insert(world, &first, NULL), "id is null"); /* and inserts nothing */
    for (int i = 0; i < BOXES; ++i) {
        SdopBoxBody body = sdop_box_body_at(box(i));
        body.fixed = i % 4 == 0;
        check(it, sdop_box_world_insert(world, &body, &ids[i]));
    }
    size_t found, begun = 0, bytes;
    check(it, sdop_box_world_cull(world, &found));
    refused(it, sdop_box_world_cull_up_to(world, found - 1, &begun), "are allowed");
    check(it, sdop_box_world_cull_up_to(world, found, &begun));
    begun = 0;
    refused(it, sdop_box_world_events(world, NULL, &begun), "take is null"); /* and takes no event */
    check(it, sdop_box_world_events(world, count_event, &begun));
    assert(begun == found && ids[0] == 0);
    refused(it, sdop_box_world_snapshot(world, NULL, 0, &bytes), "larger buffer");
    uint8_t *saved = malloc(bytes);
    check(it, sdop_box_world_snapshot(world, saved, bytes, &bytes));
    check(it, sdop_box_world_remove(world, ids[1]));
    refused(it, sdop_box_world_remove(world, ids[1]), "no longer");
    check(it, sdop_box_world_restore(world, saved, bytes));
    refused(it, sdop_box_world_restore(world, saved, bytes / 2), "no snapshot");
    free(saved);
    check(it, sdop_box_world_exclude(world, ids[1], ids[2]));
    check(it, sdop_box_world_cull(world, &found));
    SdopBoxBody read;
    check(it, sdop_box_world_set_motion(world, ids[1], false, true));
    check(it, sdop_box_world_body(world, ids[1], &read));
    assert(read.resting && !read.fixed && read.bounds.max[0] == box(1).max[0]);
    uint64_t present[BOXES];
    size_t count, summed = 0;
    check(it, sdop_box_world_ids(world, present, BOXES, &count));
    assert(count == BOXES && memcmp(present, ids, sizeof ids) == 0);
    check(it, sdop_box_world_cull_each(world, count_id_pairs, &summed));
    assert(summed == found);
    sdop_box_world_free(world);
    return begun;
}

static size_t bodies(Caller *it) {
    SdopShape *own, *whole;
    const double vertices[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, outside[1][3] = {{0, 1, 4}};
    check(it, sdop_shape_new(vertices, 4, triangles, 4, NULL, &own));
    refused(it, sdop_shape_new(vertices, 4, outside, 1, NULL, &whole), "4");
    check(it, sdop_compound_shape(compound, &whole));
    const SdopShape *const shapes[] = {own, whole};
    SdopWorld *world;
    check(it, sdop_world_new(shapes, 2, NULL, &world));
    sdop_shape_free(own);
    sdop_shape_free(whole);
    uint64_t id;
    for (int i = 0; i < BODIES; ++i) {
        const SdopBody body = sdop_body_at((uint32_t)i % 2, 0.75 * i, 0, 0);
        check(it, sdop_world_insert(world, &body, &id));
    }
    size_t found, parts;
    refused(it, sdop_world_cull_up_to(world, 0, &found), "are allowed");
    check(it, sdop_world_cull(world, &found));
    SdopPartCuller *culler;
    check(it, sdop_part_culler_new(&culler));
    check(it, sdop_part_culler_set_parts(culler, 1, compound));
    check(it, sdop_part_culler_cull(culler, world, &parts));
    refused(it, sdop_world_insert(world, NULL, &id), "body is null");
    const SdopBody late = sdop_body_at(1, 0, 0, 9);
    check(it, sdop_world_insert(world, &late, &id));
    refused(it, sdop_part_culler_cull(culler, world, &parts), "has changed since its last cull");
    check(it, sdop_world_cull(world, &found));
    check(it, sdop_part_culler_set_parts(culler, 0, compound));
    refused(it, sdop_part_culler_cull(culler, world, &parts), "the-arm");
    refused(it, sdop_world_replace_shape(world, 9, shape), "9");
    check(it, sdop_world_replace_shape(world, 0, shape));
    SdopBody read;
    check(it, sdop_world_set_motion(world, id, true, true));
    check(it, sdop_world_body(world, id, &read));
    assert(read.fixed && !read.resting && read.shape == 1 && read.translation[2] == 9);
    uint64_t present[BODIES + 1];
    size_t count, summed = 0;
    check(it, sdop_world_ids(world, present, BODIES + 1, &count));
    assert(count == BODIES + 1 && present[BODIES] == id);
    check(it, sdop_world_set_interest(world, present, 2));
    check(it, sdop_world_cull_each(world, count_id_pairs, &summed));
    assert(summed == found);
    sdop_part_culler_free(culler);
    sdop_world_free(world);
    return found + parts;
}

static void fixed_bodies(Caller *it) {
    const float rotation[2][4] = {{0, 0, 0, 1}, {0, 0, 0, 1}}, translation[2][3] = {{0, 0, 0}, {0.5F, 0, 0}};
    const uint32_t numbers[2] = {0, 0};
    const SdopShape *const shapes[] = {shape};
    const SdopBodies set = {.count = 2, .shape = numbers, .rotation = rotation, .translation = translation};
    SdopCuller *culler;
    check(it, sdop_culler_new(shapes, 1, &set, NULL, &culler));
    size_t summed = 0;
    check(it, sdop_culler_cull_each(culler, rotation, translation, count_pairs, &summed));
    assert(summed == 1);
    sdop_culler_free(culler);
}

/* Boxes and bodies where space repeats. */
static void cells(Caller *it) {
    const double cell[3] = {10, 0, 0};
    const SdopShape *const shapes[] = {shape};
    const SdopPeriodicBox box = sdop_periodic_box_between(9, 0, 0, 11, 1, 1);
    const SdopBody body = sdop_body_at(0, 13, 0, 0);
    SdopPeriodicBoxes *boxes;
    SdopPeriodicWorld *world;
    check(it, sdop_periodic_boxes_new(&cell, NULL, 1, &boxes));
    check(it, sdop_periodic_world_new(shapes, 1, &cell, NULL, &world));
    uint64_t ids[2], present;
    check(it, sdop_periodic_boxes_insert(boxes, &box, &ids[0]));
    check(it, sdop_periodic_world_insert(world, &body, &ids[1]));
    SdopPeriodicBox box_read;
    SdopBody body_read;
    check(it, sdop_periodic_boxes_body(boxes, ids[0], &box_read));
    check(it, sdop_periodic_world_body(world, ids[1], &body_read));
    assert(box_read.max[0] == 11 && body_read.translation[0] == 13);
    size_t count;
    check(it, sdop_periodic_boxes_ids(boxes, &present, 1, &count));
    assert(count == 1 && present == ids[0]);
    check(it, sdop_periodic_world_ids(world, &present, 1, &count));
    assert(count == 1 && present == ids[1]);
    sdop_periodic_boxes_free(boxes);
    sdop_periodic_world_free(world);
}

static size_t questions(Caller *it) {
    const double min[3] = {3, 3, 1}, max[3] = {6, 6, 3};
    uint64_t ids[BOXES];
    SdopHit hits[BOXES];
    size_t near, crossed;
    bool is_hit;
    check(it, sdop_query_index_touching_box(index_of_boxes, &min, &max, ids, BOXES, &near));
    refused(it, sdop_query_index_touching_ball(index_of_boxes, &min, -1, ids, BOXES, &near), "radius");
    const SdopSegment segment = {{-1, -1, -1}, {14, 12, 6}};
    check(it, sdop_query_index_first(index_of_boxes, &segment, hits, &is_hit));
    check(it, sdop_query_index_along(index_of_boxes, &segment, hits, BOXES, &crossed));
    assert(is_hit == (crossed > 0));
    const double origin[3] = {-1, -1, -1}, direction[3] = {15, 13, 7}, turned[4] = {0, 0, 1, 1};
    SdopIdPair pairs[BOXES * BOXES];
    size_t count;
    check(it, sdop_query_index_first_of_ray(index_of_boxes, &origin, &direction, hits, &is_hit));
    check(it, sdop_query_index_along_ray(index_of_boxes, &origin, &direction, hits, BOXES, &count));
    assert(is_hit && count >= crossed);
    check(it, sdop_query_index_touching_shape(index_of_boxes, shape, &turned, &min, 3, ids, BOXES, &count));
    assert(count > 0);
    check(it, sdop_query_index_pairs_with(index_of_boxes, index_of_boxes, pairs, BOXES * BOXES, &count));
    assert(count > BOXES); /* each with itself, too */
    const float apart[3] = {3, 0, 0};
    assert(!sdop_pair_test_may_touch(pair_test, 0, 0, &IDENTITY, &apart));
    return near + crossed;
}

static size_t one_round(Caller *it) {
    fixed_bodies(it);
    cells(it);
    const size_t found[] = {frames_of_boxes(it), world_of_boxes(it), bodies(it), questions(it)};
    assert(found[0] > 10 && found[1] > 5 && found[2] > 5 && found[3] > 3);
    return found[0] * 1000000 + found[1] * 10000 + found[2] * 100 + found[3];
}

static void *call(void *given) {
    Caller *it = given;
    it->pairs = one_round(it);
    for (long i = 1; i < it->rounds; ++i) assert(one_round(it) == it->pairs);
    pthread_barrier_wait(&all_have_called);
    return NULL;
}

/* Calls from all threads; the sum of what they found. */
static size_t all_threads(long rounds, long *calls) {
    Caller callers[THREADS];
    pthread_t threads[THREADS];
    size_t found = 0;
    for (int i = 0; i < THREADS; ++i) {
        callers[i] = (Caller){i, rounds, 0, 0};
        assert(pthread_create(&threads[i], NULL, call, &callers[i]) == 0);
    }
    for (int i = 0; i < THREADS; ++i) {
        assert(pthread_join(threads[i], NULL) == 0);
        assert(callers[i].pairs == callers[0].pairs);
        found += callers[i].pairs;
        *calls += callers[i].calls;
    }
    return found;
}

static void prepare(Caller *it) {
    const double vertices[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    check(it, sdop_shape_new(vertices, 4, triangles, 4, NULL, &shape));
    const float speed[3] = {3, 4, 0}, turn[3] = {0, 0, 0};
    float margin;
    check(it, sdop_shape_swept_margin(shape, &speed, &turn, 0.5F, &margin));
    assert(margin >= 2.5F && margin < 2.501F);
    SdopShape *loaded;
    FILE *file = fopen("target/c/triangle.obj", "w");
    assert(file && fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", file) > 0 && fclose(file) == 0);
    check(it, sdop_shape_load("target/c/triangle.obj", NULL, &loaded));
    sdop_shape_free(loaded);
    refused(it, sdop_shape_load("no-such.stl", NULL, &loaded), "no-such.stl");
    refused(it, sdop_shape_load(NULL, NULL, &loaded), "path is null");
    const SdopShape *const shapes[] = {shape};
    const SdopPart parts[] = {{0, {0, 0, 0, 1}, {0, 0, 0}, false}, {0, {0, 0, 0, 1}, {1.5, 0, 0}, false}};
    check(it, sdop_compound_new("the-arm", shapes, 1, parts, 2, &compound));
    check(it, sdop_pair_test_new(0, &pair_test));
    uint32_t number;
    check(it, sdop_pair_test_add(pair_test, shape, &number));
    SdopBoxWorld *world;
    check(it, sdop_box_world_new(NULL, 1, &world));
    uint64_t id;
    for (int i = 0; i < BOXES; ++i) {
        const SdopBoxBody body = sdop_box_body_at(box(i));
        check(it, sdop_box_world_insert(world, &body, &id));
    }
    check(it, sdop_query_index_with(1, BOXES * BOXES, &index_of_boxes));
    check(it, sdop_query_index_update_boxes(index_of_boxes, world));
    sdop_box_world_free(world);
}

int main(int count, char **arguments) {
    const long rounds = count > 1 ? atol(arguments[1]) : 500;
    Caller first = {0, 0, 0, 0};
    prepare(&first);
    assert(pthread_barrier_init(&all_have_called, NULL, THREADS) == 0);
    long calls = 0;
    const size_t wanted = all_threads(1, &calls);
    const size_t before = mallinfo2().uordblks;
    assert(all_threads(rounds, &calls) == wanted);
    const size_t after = mallinfo2().uordblks;
    printf("%ld calls; %zd bytes more in use\n", calls, (ptrdiff_t)(after - before));
    assert(after <= before);
    pthread_barrier_destroy(&all_have_called);
    sdop_query_index_free(index_of_boxes);
    sdop_pair_test_free(pair_test);
    sdop_compound_free(compound);
    sdop_shape_free(shape);
    return 0;
}
