// Bullet's btDbvtBroadphase: two trees that are updated body by body, and a cache of pairs.
//
// No velocity prediction. Where all boxes are given in each frame, there is no margin, and the tree
// is tested against itself once per frame, not once per moved body, which is faster if all bodies
// move. The whole cache is cleaned up then, so that it holds only the present pairs.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <memory>
#include <vector>

#include "peer.h"
PEER(bullet)

namespace {

struct Bullet {
    btHashedOverlappingPairCache cache;
    btDbvtBroadphase broad_phase{&cache};
    std::vector<btBroadphaseProxy*> proxies;
    std::vector<Pair> pairs;
};

btVector3 corner(const Box& box, int side) {
    return btVector3(box.ends[0][side], box.ends[1][side], box.ends[2][side]);
}

std::unique_ptr<Bullet> made(const Box* boxes, size_t count, bool deferred, int cleaned) {
    auto peer = std::make_unique<Bullet>();
    peer->broad_phase.setVelocityPrediction(0);
    peer->broad_phase.m_deferedcollide = deferred;
    peer->broad_phase.m_cupdates = cleaned;
    for (size_t i = 0; i < count; i++) {
        void* number = reinterpret_cast<void*>(i);
        peer->proxies.push_back(
            peer->broad_phase.createProxy(corner(boxes[i], 0), corner(boxes[i], 1), 0, number, 1, 1, nullptr));
    }
    return peer;
}

}  // namespace

void* bullet_new(const Box* boxes, size_t count, unsigned) {
    gDbvtMargin = 0;
    return made(boxes, count, true, 100).release();
}

// Moved bodies search the trees one by one, which is the default and faster if few move; so many
// per cent of the pairs are looked through for ended ones in each frame.
extern "C" void* bullet_movers_new(const Box* boxes, size_t count, int cleaned) {
    return made(boxes, count, false, cleaned).release();
}

extern "C" void bullet_move(void* user, float margin, const uint32_t* bodies, const Box* boxes, size_t count) {
    gDbvtMargin = margin;
    Bullet& peer = *static_cast<Bullet*>(user);
    for (size_t i = 0; i < count; i++) {
        peer.broad_phase.setAabb(peer.proxies[bodies[i]], corner(boxes[i], 0), corner(boxes[i], 1), nullptr);
    }
    peer.broad_phase.calculateOverlappingPairs(nullptr);
}

void bullet_frame(void* user, const Box* boxes) {
    Bullet& peer = *static_cast<Bullet*>(user);
    for (size_t i = 0; i < peer.proxies.size(); i++) {
        peer.broad_phase.setAabb(peer.proxies[i], corner(boxes[i], 0), corner(boxes[i], 1), nullptr);
    }
    peer.broad_phase.calculateOverlappingPairs(nullptr);
}

const Pair* bullet_pairs(void* user, size_t* count) {
    Bullet& peer = *static_cast<Bullet*>(user);
    const btBroadphasePairArray& cached = peer.cache.getOverlappingPairArray();
    peer.pairs.clear();
    for (int at = 0; at < cached.size(); at++) {
        const auto number = [](const btBroadphaseProxy* proxy) {
            return static_cast<uint32_t>(reinterpret_cast<size_t>(proxy->m_clientObject));
        };
        peer.pairs.push_back({number(cached[at].m_pProxy0), number(cached[at].m_pProxy1)});
    }
    *count = peer.pairs.size();
    return peer.pairs.data();
}

void bullet_free(void* user) {
    Bullet* peer = static_cast<Bullet*>(user);
    for (btBroadphaseProxy* proxy : peer->proxies) peer->broad_phase.destroyProxy(proxy, nullptr);
    delete peer;
}
