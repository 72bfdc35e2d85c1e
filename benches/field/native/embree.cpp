// Embree: a tree over user geometry, built anew for speed each frame and collided with itself.
//
// Embree hands out pairs of primitives whose boxes overlap, in both orders and each with itself, in
// batches and from several threads.
#include <embree3/rtcore.h>

#include <mutex>
#include <string>
#include <vector>

#include "engine.h"
ENGINE(embree)

namespace {

struct Embree {
    RTCDevice device;
    RTCScene scene;
    RTCGeometry geometry;
    const Box* boxes;
    std::mutex mutex;
    std::vector<Pair> pairs;
};

void bounds(const RTCBoundsFunctionArguments* arguments) {
    const Box& box = static_cast<Embree*>(arguments->geometryUserPtr)->boxes[arguments->primID];
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = box.ends[0][0];
    out.lower_y = box.ends[1][0];
    out.lower_z = box.ends[2][0];
    out.upper_x = box.ends[0][1];
    out.upper_y = box.ends[1][1];
    out.upper_z = box.ends[2][1];
}

void collide(void* user, RTCCollision* collisions, unsigned count) {
    Embree& engine = *static_cast<Embree*>(user);
    std::lock_guard<std::mutex> lock(engine.mutex);
    for (unsigned at = 0; at < count; at++) {
        const uint32_t i = collisions[at].primID0, j = collisions[at].primID1;
        if (i < j) engine.pairs.push_back({i, j});
    }
}

}  // namespace

void* embree_new(const Box* boxes, size_t count, uint32_t threads, uint32_t) {
    const std::string configuration = "threads=" + std::to_string(threads);
    RTCDevice device = rtcNewDevice(configuration.c_str());
    if (!device) return nullptr;
    Embree* engine = new Embree{device, rtcNewScene(device), rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER), boxes, {}, {}};
    rtcSetSceneBuildQuality(engine->scene, RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(engine->scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetGeometryBuildQuality(engine->geometry, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserPrimitiveCount(engine->geometry, static_cast<unsigned>(count));
    rtcSetGeometryUserData(engine->geometry, engine);
    rtcSetGeometryBoundsFunction(engine->geometry, bounds, nullptr);
    rtcCommitGeometry(engine->geometry);
    rtcAttachGeometry(engine->scene, engine->geometry);
    return engine;
}

void embree_frame(void* user, const uint32_t*, const Box* boxes, size_t) {
    Embree& engine = *static_cast<Embree*>(user);
    engine.boxes = boxes;
    engine.pairs.clear();
    rtcCommitGeometry(engine.geometry);
    rtcCommitScene(engine.scene);
    rtcCollide(engine.scene, engine.scene, collide, &engine);
}

const Pair* embree_pairs(void* user, size_t* count) {
    const Embree& engine = *static_cast<Embree*>(user);
    *count = engine.pairs.size();
    return engine.pairs.data();
}

void embree_free(void* user) {
    Embree* engine = static_cast<Embree*>(user);
    rtcReleaseGeometry(engine->geometry);
    rtcReleaseScene(engine->scene);
    rtcReleaseDevice(engine->device);
    delete engine;
}
