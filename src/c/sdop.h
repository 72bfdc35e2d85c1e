/* sdop: collision culling that never misses a touching pair. Made by cbindgen from src/c.

   A function that can fail returns a status and leaves the reason, with its remedy, in
   sdop_last_error. Handles may move between threads. Only one thread at a time may use a handle,
   except in functions that take it as const: such calls may run at the same time.

   Of every function: a handle comes from the function that makes such handles, and is not used after
   it was freed. A column has as many entries as the count beside it says, or one for each body; a
   vector or a quaternion has its 3 or 4 numbers; a text ends with a zero. What a call gives may be
   written: `capacity` entries of `buffer`, and one value behind any other pointer that isn't const.
   A callback may be called with its `user`. Null is refused, unless the function says what it means. */

#ifndef SDOP_H
#define SDOP_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* In all groups, and collides with all. */
#ifdef __cplusplus
#define SdopGroups_ALL (SdopGroups{UINT32_MAX, UINT32_MAX})
#else
#define SdopGroups_ALL ((SdopGroups){.member = UINT32_MAX, .mask = UINT32_MAX})
#endif

// How a pair has changed.
typedef enum {
  // Reported now and not before.
  SDOP_EVENT_KIND_BEGUN = 0,
  // Reported now and before.
  SDOP_EVENT_KIND_PERSISTING = 1,
  // Reported before and not now.
  SDOP_EVENT_KIND_ENDED = 2,
} SdopEventKind;

// How a call ended.
typedef enum {
  // The call succeeded.
  SDOP_STATUS_OK = 0,
  // Invalid input. Entries of a column before the invalid one have been applied.
  SDOP_STATUS_REFUSED = 1,
  // The buffer is too small; the count says how much is needed.
  SDOP_STATUS_TOO_SMALL = 2,
  // A pointer that must not be null is null.
  SDOP_STATUS_NULL = 3,
  // A bug of sdop: free the handle, and report it.
  SDOP_STATUS_BUG = 4,
} SdopStatus;

// Finds the boxes that meet, frame after frame.
typedef struct SdopBoxCuller SdopBoxCuller;

// A long-lived set of boxes: ids that stay, groups, pairs and events.
typedef struct SdopBoxWorld SdopBoxWorld;

// Several shapes that move as one body.
typedef struct SdopCompound SdopCompound;

// Culls the frames of a fixed set of bodies whose poses change.
typedef struct SdopCuller SdopCuller;

// The or-DOPs of shapes, as they are and grown by margins, for tests of single pairs.
typedef struct SdopPairTest SdopPairTest;

// Finds the pairs of parts within the pairs of bodies that a world reports.
typedef struct SdopPartCuller SdopPartCuller;

// A long-lived set of boxes in space that repeats along some axes.
typedef struct SdopPeriodicBoxes SdopPeriodicBoxes;

// A long-lived set of bodies in space that repeats along some axes. Along a periodic axis, the
// ball about a body, with its margin, has to be smaller than half of the period.
typedef struct SdopPeriodicWorld SdopPeriodicWorld;

// The bodies of a world, prepared for queries. Many threads may query it at the same time, while
// none updates it.
typedef struct SdopQueryIndex SdopQueryIndex;

// A mesh with its bounding ball and or-DOP.
typedef struct SdopShape SdopShape;

// A long-lived set of bodies: ids that stay, groups, margins, translations in double, pairs and
// events.
typedef struct SdopWorld SdopWorld;

// How a mesh becomes a shape. All zeros is the default.
typedef struct {
  // Number of or-DOP faces: 6, 14, 18 or 26; 0 is 18.
  uint32_t k;
  // Scales the mesh about its origin until its smallest enclosing ball has this radius; 0 keeps
  // its size.
  float radius;
  // Whether poses place the centre of the smallest enclosing ball instead of the mesh's own
  // origin.
  bool about_ball;
  // Whether the or-DOP uses the mesh's own axes instead of the principal axes of its hull.
  bool on_model_axes;
} SdopShapeSpec;

// Which groups a body is in, and which it collides with: one bit per group.
typedef struct {
  // The groups that the body is in.
  uint32_t member;
  // The groups that it collides with.
  uint32_t mask;
} SdopGroups;

// Bodies as columns of `count` entries.
typedef struct {
  // Number of bodies.
  size_t count;
  // For each body, the number of its shape.
  const uint32_t *shape;
  // Whether each body may move; null: all may. A pair of two bodies that may not is never
  // reported.
  const bool *dynamic;
  // Quaternions x, y, z, w of any non-zero norm.
  const float (*rotation)[4];
  // Translations of the bodies' origins, world frame.
  const float (*translation)[3];
  // Which bodies may collide; null: all.
  const SdopGroups *groups;
} SdopBodies;

// How bodies are culled. All zeros is the default.
typedef struct {
  // Which volumes are tested; null is "s-dop-sequential", spheres and then or-DOPs.
  const char *strategy;
  // The finder of candidate pairs; null is "auto".
  const char *finder;
  // Number of threads; 0 is 1.
  size_t threads;
} SdopOptions;

// Two bodies by their numbers, the lower one first.
typedef struct {
  // The lower number.
  uint32_t first;
  // The higher number.
  uint32_t second;
} SdopPair;

// Receives some of a frame's pairs and their number, after the pointer that was passed along. Must
// return normally.
typedef void (*SdopTakePairs)(void*, const SdopPair*, size_t);

// A closed, world-aligned box: boxes that touch meet. Its ends are finite, and each lower end is
// at most the upper one; sides may have no length.
typedef struct {
  // The lower corner.
  float min[3];
  // The upper corner.
  float max[3];
} SdopBox;

// A box to be inserted.
typedef struct {
  // Where it is.
  SdopBox bounds;
  // Whether it is scenery; pairs of two such boxes are never reported.
  bool fixed;
  // Whether it lies still for the time being; its pairs stay.
  bool resting;
  // Which boxes it may collide with; all bits for all.
  SdopGroups groups;
} SdopBoxBody;

// Two bodies of a world by their ids, the lower slot first.
typedef struct {
  // The id of the lower slot.
  uint64_t first;
  // The id of the higher slot.
  uint64_t second;
} SdopIdPair;

// As `SdopTakePairs`, of a world.
typedef void (*SdopTakeIdPairs)(void*, const SdopIdPair*, size_t);

// A pair and how it has changed.
typedef struct {
  // How it has changed.
  SdopEventKind kind;
  // The pair.
  SdopIdPair pair;
} SdopEvent;

// Receives an event, after the pointer that was passed along. Must return normally.
typedef void (*SdopTakeEvent)(void*, SdopEvent);

// A shape in the frame of a body.
typedef struct {
  // Index into the compound's shapes.
  uint32_t shape;
  // Orientation in the frame of the body: a quaternion (x, y, z, w) of any non-zero norm.
  float rotation[4];
  // Position of the shape's origin in the frame of the body.
  double translation[3];
  // Whether the rotation was rounded from f64: `turned` sets it. The part is then grown by what
  // that may move its points.
  bool rounded;
} SdopPart;

// Two parts of two bodies.
typedef struct {
  // The bodies.
  SdopIdPair bodies;
  // The number of the first body's part; 0 if its shape is not a compound.
  uint32_t first_part;
  // The number of the second body's part; 0 if its shape is not a compound.
  uint32_t second_part;
} SdopPartPair;

// A box in space that repeats. It may be anywhere; along a periodic axis it has to be shorter than
// half of the period.
typedef struct {
  // The lower corner.
  double min[3];
  // The upper corner.
  double max[3];
  // Whether it is scenery; pairs of two such boxes are never reported.
  bool fixed;
  // Whether it lies still for the time being; its pairs stay.
  bool resting;
  // Which boxes it may collide with; all bits for all.
  SdopGroups groups;
} SdopPeriodicBox;

// Two bodies, of which the second touches the first when it is moved by whole periods.
typedef struct {
  // The bodies.
  SdopIdPair bodies;
  // The number of periods along each axis by which the second body is moved, from where it was
  // put.
  int32_t image[3];
} SdopPeriodicPair;

// A pair of a periodic world and how it has changed. A pair that has ended has its former image.
typedef struct {
  // How it has changed.
  SdopEventKind kind;
  // The pair.
  SdopPeriodicPair pair;
} SdopPeriodicEvent;

// Receives an event of a periodic world, after the pointer that was passed along. Must return
// normally.
typedef void (*SdopTakePeriodicEvent)(void*, SdopPeriodicEvent);

// A body to be inserted.
typedef struct {
  // Number of its shape.
  uint32_t shape;
  // Whether it is scenery; pairs of two such bodies are never reported.
  bool fixed;
  // Whether it lies still for the time being; its pairs stay.
  bool resting;
  // Quaternion x, y, z, w of any non-zero norm.
  float rotation[4];
  // Translation of its origin, world frame.
  double translation[3];
  // Contact margin, a length: pairs are reported whose meshes, each grown by its margin, meet.
  float margin;
  // Which bodies it may collide with; all bits for all.
  SdopGroups groups;
  // Whether the rotation was rounded from double: `sdop_body_turned` sets it. The body is then
  // grown by what that may move its points.
  bool rounded;
} SdopBody;

// The points from + s·(to − from) for 0 ≤ s ≤ 1, world frame.
typedef struct {
  // The point of s = 0.
  double from[3];
  // The point of s = 1.
  double to[3];
} SdopSegment;

// A body that a segment may meet.
typedef struct {
  // The body.
  uint64_t id;
  // An s at or before the first point that the segment shares with the body.
  double at;
} SdopHit;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library, such as "0.1.0".
const char *sdop_version(void);

// Why the last call on this thread failed and how to mend it, until the next call; empty if it did
// not.
const char *sdop_last_error(void);

// Makes a shape of vertices in the mesh's own frame, to whose origin poses refer, and vertex
// indices of triangles. Its volumes are grown by what rounding the vertices to float moves. `spec`
// may be null.
SdopStatus sdop_shape_new(const double (*vertices)[3],
                          size_t vertex_count,
                          const uint32_t (*triangles)[3],
                          size_t triangle_count,
                          const SdopShapeSpec *spec,
                          SdopShape **out);

// Makes a shape of the mesh in a file: OBJ, STL, PLY, OFF or `.tri`. `spec` may be null.
SdopStatus sdop_shape_load(const char *path, const SdopShapeSpec *spec, SdopShape **out);

// Frees a shape; null is fine. Cullers and worlds keep copies.
void sdop_shape_free(SdopShape *shape);

// The margin that a body needs for a whole step of `seconds`, if its origin is at most as fast as
// `linear` and it turns at most as fast as `angular`, in radians per second. Two bodies with such
// margins that meet at any time of the step are a pair at its start.
SdopStatus sdop_shape_swept_margin(const SdopShape *shape,
                                   const float (*linear)[3],
                                   const float (*angular)[3],
                                   float seconds,
                                   float *margin);

// Makes the culler of these bodies. `options` may be null.
SdopStatus sdop_culler_new(const SdopShape *const *shapes,
                           size_t shape_count,
                           const SdopBodies *bodies,
                           const SdopOptions *options,
                           SdopCuller **out);

// Frees a culler; null is fine.
void sdop_culler_free(SdopCuller *culler);

// Finds the pairs that might touch at these poses, one of each column for each body. Static bodies
// that have moved are found where they are now; such a frame takes about twice as long. `pairs`
// gets their number; read them with `sdop_culler_pairs`.
SdopStatus sdop_culler_cull(SdopCuller *culler,
                            const float (*rotation)[4],
                            const float (*translation)[3],
                            size_t *pairs);

// `sdop_culler_cull`, if there are at most `limit` pairs; more are an error that has their number,
// and memory for them is never allocated.
SdopStatus sdop_culler_cull_up_to(SdopCuller *culler,
                                  const float (*rotation)[4],
                                  const float (*translation)[3],
                                  size_t limit,
                                  size_t *pairs);

// Copies the pairs of the last frame into `buffer`. If they don't fit, `count` says how many there
// are.
SdopStatus sdop_culler_pairs(SdopCuller *culler, SdopPair *buffer, size_t capacity, size_t *count);

// Culls as `sdop_culler_cull` does and passes the pairs to `take`, about 65,000 at a time, so that
// memory doesn't grow with their number. With several threads, `take` is called from any of them,
// one call at a time.
SdopStatus sdop_culler_cull_each(SdopCuller *culler,
                                 const float (*rotation)[4],
                                 const float (*translation)[3],
                                 SdopTakePairs take,
                                 void *user);

// A box that is neither fixed nor resting, in all groups. Change what differs.
SdopBoxBody sdop_box_body_at(SdopBox bounds);

// Makes a world without boxes. `finder` is "auto" if null; 0 threads are 1.
SdopStatus sdop_box_world_new(const char *finder, size_t threads, SdopBoxWorld **out);

// Frees a world; null is fine.
void sdop_box_world_free(SdopBoxWorld *world);

// Adds a box; `id` gets its id, which stays until the box is removed.
SdopStatus sdop_box_world_insert(SdopBoxWorld *world, const SdopBoxBody *body, uint64_t *id);

// Reads a box.
SdopStatus sdop_box_world_body(const SdopBoxWorld *world, uint64_t id, SdopBoxBody *body);

// Copies the ids of all boxes into `buffer`, sorted by slots. If they don't fit, `count` says how
// many there are.
SdopStatus sdop_box_world_ids(const SdopBoxWorld *world, uint64_t *buffer, size_t capacity, size_t *count);

// Removes a box.
SdopStatus sdop_box_world_remove(SdopBoxWorld *world, uint64_t id);

// Changes a box in any of its properties.
SdopStatus sdop_box_world_set(SdopBoxWorld *world, uint64_t id, const SdopBoxBody *body);

// Moves boxes: columns of ids and boxes. If one is rejected, those before it have moved.
SdopStatus sdop_box_world_set_bounds(SdopBoxWorld *world,
                                     const uint64_t *ids,
                                     const SdopBox *boxes,
                                     size_t count);

// Puts a box to rest, wakes it, or fixes it. The first two change no pair and cost nothing.
SdopStatus sdop_box_world_set_motion(SdopBoxWorld *world, uint64_t id, bool fixed, bool resting);

// Never reports the pair of two boxes again until it is included or one of them is removed.
SdopStatus sdop_box_world_exclude(SdopBoxWorld *world, uint64_t a, uint64_t b);

// Reports the pair of two boxes again when it meets.
SdopStatus sdop_box_world_include(SdopBoxWorld *world, uint64_t a, uint64_t b);

// Finds the boxes that meet now. `pairs` gets their number; read them with `sdop_box_world_pairs`.
SdopStatus sdop_box_world_cull(SdopBoxWorld *world, size_t *pairs);

// `sdop_box_world_cull`, if there are at most `limit` pairs; more are an error that
// has their number, and memory for them is never allocated.
SdopStatus sdop_box_world_cull_up_to(SdopBoxWorld *world, size_t limit, size_t *pairs);

// Copies the pairs of the last cull into `buffer`, sorted by slots. If they don't fit, `count`
// says how many there are.
SdopStatus sdop_box_world_pairs(SdopBoxWorld *world, SdopIdPair *buffer, size_t capacity, size_t *count);

// Culls as `sdop_box_world_cull` does and passes the pairs to `take`, not sorted, about 65,000 at
// a time: the world keeps none. With several threads, `take` is called from any of them, one call
// at a time.
SdopStatus sdop_box_world_cull_each(SdopBoxWorld *world, SdopTakeIdPairs take, void *user);

// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
// function.
SdopStatus sdop_box_world_events(SdopBoxWorld *world, SdopTakeEvent take, void *user);

// Copies the world as bytes into `buffer`, for `sdop_box_world_restore`. If they don't fit,
// `count` says how many there are.
SdopStatus sdop_box_world_snapshot(SdopBoxWorld *world, uint8_t *buffer, size_t capacity, size_t *count);

// Gives this world the state of a snapshot.
SdopStatus sdop_box_world_restore(SdopBoxWorld *world, const uint8_t *bytes, size_t count);

// Rounds boxes in double, each the lower corner x, y, z and then the upper one, to the smallest
// boxes of floats that contain them. No pair is missed that way; boxes that are less than that
// apart may be reported.
SdopStatus sdop_boxes_outward(const double (*boxes)[6], size_t count, SdopBox *out);

// Makes a culler of boxes. `finder` is "auto" if null; 0 threads are 1.
SdopStatus sdop_box_culler_new(const char *finder, size_t threads, SdopBoxCuller **out);

// Frees a culler; null is fine.
void sdop_box_culler_free(SdopBoxCuller *culler);

// Finds the pairs of boxes that meet, touching included, and whose groups collide. If `groups` is
// null, all collide. `pairs` gets their number; read them with `sdop_box_culler_pairs`.
SdopStatus sdop_box_culler_cull(SdopBoxCuller *culler,
                                const SdopBox *boxes,
                                const SdopGroups *groups,
                                size_t count,
                                size_t *pairs);

// `sdop_box_culler_cull`, if there are at most `limit` pairs; more are an error that has their
// number, and memory for them is never allocated.
SdopStatus sdop_box_culler_cull_up_to(SdopBoxCuller *culler,
                                      const SdopBox *boxes,
                                      const SdopGroups *groups,
                                      size_t count,
                                      size_t limit,
                                      size_t *pairs);

// Copies the pairs of the last frame into `buffer`, in an order that depends only on the finder
// and the frames so far. If they don't fit, `count` says how many there are.
SdopStatus sdop_box_culler_pairs(SdopBoxCuller *culler, SdopPair *buffer, size_t capacity, size_t *count);

// Culls as `sdop_box_culler_cull` does and passes the pairs to `take`, about 65,000 at a time, so
// that memory doesn't grow with their number. With several threads, `take` is called from any of
// them, one call at a time.
SdopStatus sdop_box_culler_cull_each(SdopBoxCuller *culler,
                                     const SdopBox *boxes,
                                     const SdopGroups *groups,
                                     size_t count,
                                     SdopTakePairs take,
                                     void *user);

// A part with a rotation in double, a quaternion of any non-zero norm: `rotation` gets the nearest
// floats, and `rounded` says whether they are others. No pair of the exact pose is missed.
SdopPart sdop_part_turned(SdopPart part, double x, double y, double z, double w);

// Makes a compound of parts, whose shapes are numbered as in `shapes`. `name` is for errors, and
// may be null.
SdopStatus sdop_compound_new(const char *name,
                             const SdopShape *const *shapes,
                             size_t shape_count,
                             const SdopPart *parts,
                             size_t part_count,
                             SdopCompound **out);

// Frees a compound; null is fine. Part cullers keep copies.
void sdop_compound_free(SdopCompound *compound);

// Makes the shape that contains all parts: give it to a world like any other, and free it.
SdopStatus sdop_compound_shape(const SdopCompound *compound, SdopShape **out);

// Makes a culler of parts without compounds: every shape is one part.
SdopStatus sdop_part_culler_new(SdopPartCuller **out);

// Frees a culler of parts; null is fine.
void sdop_part_culler_free(SdopPartCuller *culler);

// Sets the parts of a shape of the world. The world's shape of that number has to be the one that
// `sdop_compound_shape` made. If `compound` is null, the shape is one part again.
SdopStatus sdop_part_culler_set_parts(SdopPartCuller *culler, uint32_t shape, const SdopCompound *compound);

// Finds the pairs of parts in the pairs of the world's last cull: call it after each cull, before
// bodies change. `pairs` gets their number; read them with `sdop_part_culler_pairs`.
SdopStatus sdop_part_culler_cull(SdopPartCuller *culler, const SdopWorld *world, size_t *pairs);

// Copies the pairs of parts of the last cull into `buffer`, sorted by slots and then by parts. If
// they don't fit, `count` says how many there are.
SdopStatus sdop_part_culler_pairs(const SdopPartCuller *culler,
                                  SdopPartPair *buffer,
                                  size_t capacity,
                                  size_t *count);

// Copies the pairs of bodies of which some parts may touch into `buffer`, sorted by slots. If they
// don't fit, `count` says how many there are.
SdopStatus sdop_part_culler_body_pairs(const SdopPartCuller *culler,
                                       SdopIdPair *buffer,
                                       size_t capacity,
                                       size_t *count);

// Makes a test without shapes, of or-DOPs with `k` faces: 6, 14, 18 or 26; 0 is 18.
SdopStatus sdop_pair_test_new(uint32_t k, SdopPairTest **out);

// Frees a test; null is fine.
void sdop_pair_test_free(SdopPairTest *test);

// Adds a shape, which the test copies. `number` gets its number: 0 for the first, and one more for
// each shape that is added or grown.
SdopStatus sdop_pair_test_add(SdopPairTest *test, const SdopShape *shape, uint32_t *number);

// Adds a shape of the test grown by `margin`, a length. `number` gets the number of the grown
// shape.
SdopStatus sdop_pair_test_grow(SdopPairTest *test, uint32_t shape, float margin, uint32_t *number);

// Whether two shapes may touch, the second posed in the frame of the first by a quaternion x, y,
// z, w of any non-zero norm and the translation of its origin. False only if they are apart in
// exact arithmetic; true for null pointers, unknown numbers and poses that are not finite. Many
// threads may call it at the same time.
bool sdop_pair_test_may_touch(const SdopPairTest *test,
                              uint32_t first,
                              uint32_t second,
                              const float (*rotation)[4],
                              const float (*translation)[3]);

// A box between two corners that is neither fixed nor resting, in all groups. Change what differs.
SdopPeriodicBox sdop_periodic_box_between(double min_x,
                                          double min_y,
                                          double min_z,
                                          double max_x,
                                          double max_y,
                                          double max_z);

// Makes a world without boxes. `periods` are three lengths along x, y and z, 0 for an axis without
// a period. `finder` is "auto" if null; 0 threads are 1.
SdopStatus sdop_periodic_boxes_new(const double (*periods)[3],
                                   const char *finder,
                                   size_t threads,
                                   SdopPeriodicBoxes **out);

// Frees a world; null is fine.
void sdop_periodic_boxes_free(SdopPeriodicBoxes *world);

// Changes the periods. Boxes stay where they were put. If one is too large for them, nothing
// changes.
SdopStatus sdop_periodic_boxes_set_periods(SdopPeriodicBoxes *world, const double (*periods)[3]);

// Adds a box; `id` gets its id, which stays until the box is removed.
SdopStatus sdop_periodic_boxes_insert(SdopPeriodicBoxes *world, const SdopPeriodicBox *body, uint64_t *id);

// Reads a box, as it was inserted or set.
SdopStatus sdop_periodic_boxes_body(const SdopPeriodicBoxes *world, uint64_t id, SdopPeriodicBox *body);

// Copies the ids of all boxes into `buffer`, sorted by slots. If they don't fit, `count` says how
// many there are.
SdopStatus sdop_periodic_boxes_ids(const SdopPeriodicBoxes *world,
                                   uint64_t *buffer,
                                   size_t capacity,
                                   size_t *count);

// Removes a box.
SdopStatus sdop_periodic_boxes_remove(SdopPeriodicBoxes *world, uint64_t id);

// Moves boxes, or changes them in any of their properties: columns of ids and boxes. If one is
// rejected, those before it have changed.
SdopStatus sdop_periodic_boxes_set(SdopPeriodicBoxes *world,
                                   const uint64_t *ids,
                                   const SdopPeriodicBox *bodies,
                                   size_t count);

// Never reports the pair of two boxes again, in any image, until it is included or one of them is
// removed.
SdopStatus sdop_periodic_boxes_exclude(SdopPeriodicBoxes *world, uint64_t a, uint64_t b);

// Reports the pair of two boxes again when it meets.
SdopStatus sdop_periodic_boxes_include(SdopPeriodicBoxes *world, uint64_t a, uint64_t b);

// Finds the pairs of which an image meets. `pairs` gets their number; read them with
// `sdop_periodic_boxes_pairs`.
SdopStatus sdop_periodic_boxes_cull(SdopPeriodicBoxes *world, size_t *pairs);

// `sdop_periodic_boxes_cull`, if images have at most `limit` pairs; more are an error that has
// their number. A pair across a corner of the period is found at several images, and counts as
// often.
SdopStatus sdop_periodic_boxes_cull_up_to(SdopPeriodicBoxes *world, size_t limit, size_t *pairs);

// Copies the pairs of the last cull into `buffer`, each once, sorted by slots. If they don't fit,
// `count` says how many there are.
SdopStatus sdop_periodic_boxes_pairs(const SdopPeriodicBoxes *world,
                                     SdopPeriodicPair *buffer,
                                     size_t capacity,
                                     size_t *count);

// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
// function. Two boxes are one pair, in whatever image they meet.
SdopStatus sdop_periodic_boxes_events(SdopPeriodicBoxes *world, SdopTakePeriodicEvent take, void *user);

// Makes a world without bodies. `periods` are three lengths along x, y and z, 0 for an axis
// without a period. `options` may be null for the defaults.
SdopStatus sdop_periodic_world_new(const SdopShape *const *shapes,
                                   size_t shape_count,
                                   const double (*periods)[3],
                                   const SdopOptions *options,
                                   SdopPeriodicWorld **out);

// Frees a world; null is fine.
void sdop_periodic_world_free(SdopPeriodicWorld *world);

// Changes the periods. Bodies stay where they were put. If one is too large for them, nothing
// changes.
SdopStatus sdop_periodic_world_set_periods(SdopPeriodicWorld *world, const double (*periods)[3]);

// Adds a body; `id` gets its id, which stays until the body is removed.
SdopStatus sdop_periodic_world_insert(SdopPeriodicWorld *world, const SdopBody *body, uint64_t *id);

// Reads a body, as it was inserted or set.
SdopStatus sdop_periodic_world_body(const SdopPeriodicWorld *world, uint64_t id, SdopBody *body);

// Copies the ids of all bodies into `buffer`, sorted by slots. If they don't fit, `count` says how
// many there are.
SdopStatus sdop_periodic_world_ids(const SdopPeriodicWorld *world,
                                   uint64_t *buffer,
                                   size_t capacity,
                                   size_t *count);

// Removes a body.
SdopStatus sdop_periodic_world_remove(SdopPeriodicWorld *world, uint64_t id);

// Moves bodies, or changes them in any of their properties: columns of ids and bodies. If one is
// rejected, those before it have changed.
SdopStatus sdop_periodic_world_set(SdopPeriodicWorld *world,
                                   const uint64_t *ids,
                                   const SdopBody *bodies,
                                   size_t count);

// Never reports the pair of two bodies again, in any image, until it is included or one of them is
// removed.
SdopStatus sdop_periodic_world_exclude(SdopPeriodicWorld *world, uint64_t a, uint64_t b);

// Reports the pair of two bodies again when it meets.
SdopStatus sdop_periodic_world_include(SdopPeriodicWorld *world, uint64_t a, uint64_t b);

// Finds the pairs of which an image may touch. `pairs` gets their number; read them with
// `sdop_periodic_world_pairs`.
SdopStatus sdop_periodic_world_cull(SdopPeriodicWorld *world, size_t *pairs);

// `sdop_periodic_world_cull`, if images have at most `limit` pairs; more are an error that has
// their number. A pair across a corner of the period is found at several images, and counts as
// often.
SdopStatus sdop_periodic_world_cull_up_to(SdopPeriodicWorld *world, size_t limit, size_t *pairs);

// Copies the pairs of the last cull into `buffer`, each once, sorted by slots. If they don't fit,
// `count` says how many there are.
SdopStatus sdop_periodic_world_pairs(const SdopPeriodicWorld *world,
                                     SdopPeriodicPair *buffer,
                                     size_t capacity,
                                     size_t *count);

// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
// function. Two bodies are one pair, in whatever image they touch.
SdopStatus sdop_periodic_world_events(SdopPeriodicWorld *world, SdopTakePeriodicEvent take, void *user);

// Makes an index without bodies.
SdopStatus sdop_query_index_new(SdopQueryIndex **out);

// `sdop_query_index_new`, for the pairs of two sets: found by `threads` threads, and an error if
// there are more than `limit`.
SdopStatus sdop_query_index_with(size_t threads, size_t limit, SdopQueryIndex **out);

// Frees an index; null is fine.
void sdop_query_index_free(SdopQueryIndex *index);

// Brings the index up to date with a world: queries then see its bodies as they are now. A body
// that has not changed since the last update costs one comparison. No cull is needed.
SdopStatus sdop_query_index_update(SdopQueryIndex *index, const SdopWorld *world);

// `sdop_query_index_update` for a world of boxes.
SdopStatus sdop_query_index_update_boxes(SdopQueryIndex *index, const SdopBoxWorld *world);

// Writes the ids of the bodies that may touch a box on the world's axes into `buffer`, sorted by
// slots. No body that has a point in common with it is missed. If they don't fit, `count` says how
// many there are.
SdopStatus sdop_query_index_touching_box(const SdopQueryIndex *index,
                                         const double (*min)[3],
                                         const double (*max)[3],
                                         uint64_t *buffer,
                                         size_t capacity,
                                         size_t *count);

// `sdop_query_index_touching_box` for a ball, or a point if the radius is 0.
SdopStatus sdop_query_index_touching_ball(const SdopQueryIndex *index,
                                          const double (*centre)[3],
                                          double radius,
                                          uint64_t *buffer,
                                          size_t capacity,
                                          size_t *count);

// `sdop_query_index_touching_box` for a shape, grown by `margin`. The rotation is a quaternion of
// any non-zero norm.
SdopStatus sdop_query_index_touching_shape(const SdopQueryIndex *index,
                                           const SdopShape *shape,
                                           const double (*rotation)[4],
                                           const double (*translation)[3],
                                           float margin,
                                           uint64_t *buffer,
                                           size_t capacity,
                                           size_t *count);

// Finds the body whose volume a segment may meet first: no other is met at a smaller s. `found`
// gets whether there is such a body, and `hit`, unless it is null, gets it.
SdopStatus sdop_query_index_first(const SdopQueryIndex *index,
                                  const SdopSegment *segment,
                                  SdopHit *hit,
                                  bool *found);

// `sdop_query_index_first` for a ray, the points origin + s·direction for 0 ≤ s.
SdopStatus sdop_query_index_first_of_ray(const SdopQueryIndex *index,
                                         const double (*origin)[3],
                                         const double (*direction)[3],
                                         SdopHit *hit,
                                         bool *found);

// Writes all bodies that a segment may meet into `buffer`, sorted by s. If they don't fit, `count`
// says how many there are.
SdopStatus sdop_query_index_along(const SdopQueryIndex *index,
                                  const SdopSegment *segment,
                                  SdopHit *buffer,
                                  size_t capacity,
                                  size_t *count);

// `sdop_query_index_along` for a ray.
SdopStatus sdop_query_index_along_ray(const SdopQueryIndex *index,
                                      const double (*origin)[3],
                                      const double (*direction)[3],
                                      SdopHit *buffer,
                                      size_t capacity,
                                      size_t *count);

// Writes the pairs of a body of this index and one of another that may touch into `buffer`, in
// this order, sorted by slots. If they don't fit, `count` says how many there are.
SdopStatus sdop_query_index_pairs_with(const SdopQueryIndex *index,
                                       const SdopQueryIndex *other,
                                       SdopIdPair *buffer,
                                       size_t capacity,
                                       size_t *count);

// A body of a shape at a place in the world frame: not turned, neither fixed nor resting, without
// a margin, in all groups. Change what differs.
SdopBody sdop_body_at(uint32_t shape, double x, double y, double z);

// A body with a rotation in double, a quaternion of any non-zero norm: `rotation` gets the nearest
// floats, and `rounded` says whether they are others. No pair of the exact pose is missed.
SdopBody sdop_body_turned(SdopBody body, double x, double y, double z, double w);

// Makes a world without bodies. `shapes` may be null if there are none yet, `options` for the
// defaults.
SdopStatus sdop_world_new(const SdopShape *const *shapes,
                          size_t shape_count,
                          const SdopOptions *options,
                          SdopWorld **out);

// Frees a world; null is fine.
void sdop_world_free(SdopWorld *world);

// Adds a shape; `number` gets its number.
SdopStatus sdop_world_add_shape(SdopWorld *world, const SdopShape *shape, uint32_t *number);

// Removes a shape that no body has.
SdopStatus sdop_world_remove_shape(SdopWorld *world, uint32_t shape);

// Replaces a shape by another: its bodies have the new shape from the next cull on.
SdopStatus sdop_world_replace_shape(SdopWorld *world, uint32_t number, const SdopShape *shape);

// Adds a body; `id` gets its id, which stays until the body is removed.
SdopStatus sdop_world_insert(SdopWorld *world, const SdopBody *body, uint64_t *id);

// Reads a body.
SdopStatus sdop_world_body(const SdopWorld *world, uint64_t id, SdopBody *body);

// Copies the ids of all bodies into `buffer`, sorted by slots. If they don't fit, `count` says how
// many there are.
SdopStatus sdop_world_ids(const SdopWorld *world, uint64_t *buffer, size_t capacity, size_t *count);

// Removes a body.
SdopStatus sdop_world_remove(SdopWorld *world, uint64_t id);

// Changes a body in any of its properties.
SdopStatus sdop_world_set(SdopWorld *world, uint64_t id, const SdopBody *body);

// Moves bodies: columns of ids, rotations and translations. If one is rejected, those before it
// have moved.
SdopStatus sdop_world_set_poses(SdopWorld *world,
                                const uint64_t *ids,
                                const float (*rotation)[4],
                                const double (*translation)[3],
                                size_t count);

// Moves bodies as `sdop_world_set_poses` does, with rotations in double: no pair of the exact
// poses is missed.
SdopStatus sdop_world_set_poses_f64(SdopWorld *world,
                                    const uint64_t *ids,
                                    const double (*rotation)[4],
                                    const double (*translation)[3],
                                    size_t count);

// Puts a body to rest, wakes it, or fixes it. The first two change no pair and cost nothing.
SdopStatus sdop_world_set_motion(SdopWorld *world, uint64_t id, bool fixed, bool resting);

// Sets the bodies of interest, for the strategies that use them.
SdopStatus sdop_world_set_interest(SdopWorld *world, const uint64_t *ids, size_t count);

// Never reports the pair of two bodies again, such as two links that share a joint, until it is
// included or one of them is removed.
SdopStatus sdop_world_exclude(SdopWorld *world, uint64_t a, uint64_t b);

// Reports the pair of two bodies again when it meets.
SdopStatus sdop_world_include(SdopWorld *world, uint64_t a, uint64_t b);

// Finds the pairs that might touch now. `pairs` gets their number; read them with
// `sdop_world_pairs`.
SdopStatus sdop_world_cull(SdopWorld *world, size_t *pairs);

// `sdop_world_cull`, if there are at most `limit` pairs; more are an error that
// has their number, and memory for them is never allocated.
SdopStatus sdop_world_cull_up_to(SdopWorld *world, size_t limit, size_t *pairs);

// Copies the pairs of the last cull into `buffer`, sorted by slots. If they don't fit, `count`
// says how many there are.
SdopStatus sdop_world_pairs(SdopWorld *world, SdopIdPair *buffer, size_t capacity, size_t *count);

// Culls as `sdop_world_cull` does and passes the pairs to `take`, not sorted, about 65,000 at a
// time: the world keeps none. With several threads, `take` is called from any of them, one call at
// a time.
SdopStatus sdop_world_cull_each(SdopWorld *world, SdopTakeIdPairs take, void *user);

// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
// function.
SdopStatus sdop_world_events(SdopWorld *world, SdopTakeEvent take, void *user);

// Copies the world as bytes into `buffer`, for `sdop_world_restore`. If they don't fit, `count`
// says how many there are.
SdopStatus sdop_world_snapshot(SdopWorld *world, uint8_t *buffer, size_t capacity, size_t *count);

// Gives this world the state of a snapshot. It must have the same shapes under the same numbers.
SdopStatus sdop_world_restore(SdopWorld *world, const uint8_t *bytes, size_t count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SDOP_H */
