// Embree: a tree over user geometry, built anew for speed each frame and collided with itself.
//
// Embree hands out pairs of primitives whose boxes overlap, in both orders and each with itself, in
// batches and from several threads.
#include <embree3/rtcore.h>

#include <mutex>
#include <string>
#include <vector>

#include "peer.h"
PEER(embree)

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
    Embree& peer = *static_cast<Embree*>(user);
    std::lock_guard<std::mutex> lock(peer.mutex);
    for (unsigned at = 0; at < count; at++) {
        const uint32_t i = collisions[at].primID0, j = collisions[at].primID1;
        if (i < j) peer.pairs.push_back({i, j});
    }
}

}  // namespace

void* embree_new(const Box* boxes, size_t count, unsigned threads) {
    const std::string configuration = "threads=" + std::to_string(threads);
    RTCDevice device = rtcNewDevice(configuration.c_str());
    if (!device) return nullptr;
    Embree* peer = new Embree{device, rtcNewScene(device), rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER), boxes, {}, {}};
    rtcSetSceneBuildQuality(peer->scene, RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(peer->scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetGeometryBuildQuality(peer->geometry, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserPrimitiveCount(peer->geometry, static_cast<unsigned>(count));
    rtcSetGeometryUserData(peer->geometry, peer);
    rtcSetGeometryBoundsFunction(peer->geometry, bounds, nullptr);
    rtcCommitGeometry(peer->geometry);
    rtcAttachGeometry(peer->scene, peer->geometry);
    return peer;
}

void embree_frame(void* user, const Box* boxes) {
    Embree& peer = *static_cast<Embree*>(user);
    peer.boxes = boxes;
    peer.pairs.clear();
    rtcCommitGeometry(peer.geometry);
    rtcCommitScene(peer.scene);
    rtcCollide(peer.scene, peer.scene, collide, &peer);
}

const Pair* embree_pairs(void* user, size_t* count) {
    const Embree& peer = *static_cast<Embree*>(user);
    *count = peer.pairs.size();
    return peer.pairs.data();
}

void embree_free(void* user) {
    Embree* peer = static_cast<Embree*>(user);
    rtcReleaseGeometry(peer->geometry);
    rtcReleaseScene(peer->scene);
    rtcReleaseDevice(peer->device);
    delete peer;
}
