// S-DOP culling for Bullet: what an application copies. `src/seam.rs` is the other side.
#pragma once
#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <cmath>
#include <cstdint>

struct SdopTest;

extern "C" {
SdopTest* sdop_test_new();
void sdop_test_free(SdopTest* test);
// Adds a mesh about its body's origin, and the same grown by `margin`; returns the first's number (the second's is one more), or
// UINT32_MAX for a mesh that can't be culled.
uint32_t sdop_test_add(SdopTest* test, const float* vertices, size_t vertex_count, const uint32_t* triangles,
                       size_t triangle_count, float margin);
// Whether the two may touch; quaternion (x, y, z, w) and translation of the second in the frame of the first.
bool sdop_test_may_touch(const SdopTest* test, uint32_t first, uint32_t second, const float rotation[4],
                         const float translation[3]);
}

// Hands over to the narrow phase only pairs that may touch. A collision object takes part when `setUserIndex3` has told it its mesh's
// number; all others pass.
class CullingDispatcher : public btCollisionDispatcher {
public:
    CullingDispatcher(btCollisionConfiguration* configuration, const SdopTest* test)
        : btCollisionDispatcher(configuration), test(test) {
        setNearCallback([](btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
            if (static_cast<const CullingDispatcher&>(dispatcher).mayTouch(pair)) defaultNearCallback(pair, dispatcher, info);
        });
    }

    // False only if Bullet's narrow phase would leave the pair without contact points.
    bool mayTouch(const btBroadphasePair& pair) const {
        const auto object = [](const btBroadphaseProxy* proxy) {
            return static_cast<const btCollisionObject*>(proxy->m_clientObject);
        };
        const btCollisionObject *a = object(pair.m_pProxy0), *b = object(pair.m_pProxy1);
        const int first = a->getUserIndex3(), second = b->getUserIndex3();
        if (first < 0 || second < 0 || holdsPoints(pair) || far(a) || far(b)) return true;
        const btTransform between = a->getWorldTransform().inverseTimes(b->getWorldTransform());
        const btQuaternion turn = between.getRotation();
        const btVector3 way = between.getOrigin();
        const float rotation[4] = {turn.x(), turn.y(), turn.z(), turn.w()};
        const float translation[3] = {way.x(), way.y(), way.z()};
        return sdop_test_may_touch(test, static_cast<uint32_t>(first) + 1, static_cast<uint32_t>(second), rotation, translation);
    }

    // What a shape's mesh must be grown by: contacts are made up to both shapes' collision margins (`widest_margin` is the largest in the
    // world) and the smaller of their breaking thresholds. 1 % is for GJK, which stops early, and the last term for what rounding moves
    // within `FAR` of the origin.
    static float margin(const btCollisionShape& shape, float widest_margin) {
        const float breaking = shape.getContactBreakingThreshold(gContactBreakingThreshold);
        return 1.01f * (shape.getMargin() + widest_margin + breaking) + std::ldexp(FAR, -17);
    }

    static constexpr float FAR = 256;

private:
    // Points of earlier steps are for Bullet to refresh or to drop.
    static bool holdsPoints(const btBroadphasePair& pair) {
        if (!pair.m_algorithm) return false;
        btManifoldArray manifolds;
        pair.m_algorithm->getAllContactManifolds(manifolds);
        for (int i = 0; i < manifolds.size(); i++) {
            if (manifolds[i]->getNumContacts() > 0) return true;
        }
        return false;
    }

    static bool far(const btCollisionObject* object) {
        const btVector3 place = object->getWorldTransform().getOrigin().absolute();
        return !(place[place.maxAxis()] < FAR);
    }

    const SdopTest* test;
};
