// A scene in Bullet, stepped as it comes, with the filter, or with the filter's verdicts judged by
// Bullet's own narrow phase.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <LinearMath/btConvexHullComputer.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "culling.h"

namespace {

enum Kind : uint32_t { HULL, MESH, BOX, BALL };
enum Mode : uint32_t { PLAIN, FILTERED, JUDGED };

// Sums over steps; `src/native.rs` has the same.
struct Counts {
    uint64_t asked;     // pairs that reached the dispatcher, both bodies awake or one of them
    uint64_t rejected;  // by the filter
    uint64_t touching;  // pairs that had contact points after their check
    uint64_t dropped;   // of those, rejected
    double rejected_ns, touching_ns, test_ns;  // of Bullet's check of each, and of the filter's test of all; judged runs alone
};

double now_ns() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::nano>(now).count();
}

int points(const btBroadphasePair& pair) {
    if (!pair.m_algorithm) return 0;
    btManifoldArray manifolds;
    pair.m_algorithm->getAllContactManifolds(manifolds);
    int sum = 0;
    for (int i = 0; i < manifolds.size(); i++) sum += manifolds[i]->getNumContacts();
    return sum;
}

class CountingDispatcher : public CullingDispatcher {
public:
    CountingDispatcher(btCollisionConfiguration* configuration, const SdopPairTest* test, Mode mode)
        : CullingDispatcher(configuration, test), mode(mode) {
        setNearCallback([](btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
            static_cast<CountingDispatcher&>(dispatcher).near(pair, info);
        });
    }

    Counts counts{};

private:
    void near(btBroadphasePair& pair, const btDispatcherInfo& info) {
        const auto object = [](btBroadphaseProxy* proxy) { return static_cast<btCollisionObject*>(proxy->m_clientObject); };
        if (!needsCollision(object(pair.m_pProxy0), object(pair.m_pProxy1))) return;
        counts.asked++;
        if (mode != JUDGED) {
            if (mode == PLAIN || mayTouch(pair)) {
                defaultNearCallback(pair, *this, info);
            } else {
                counts.rejected++;
            }
            return;
        }
        const double start = now_ns();
        const bool rejected = !mayTouch(pair);
        const double tested = now_ns();
        defaultNearCallback(pair, *this, info);
        const double checked = now_ns();
        const bool touches = points(pair) > 0;
        counts.test_ns += tested - start;
        counts.rejected += rejected;
        counts.touching += touches;
        counts.dropped += rejected && touches;
        if (rejected) counts.rejected_ns += checked - tested;
        if (touches) counts.touching_ns += checked - tested;
    }

    Mode mode;
};

struct Scene {
    std::unique_ptr<SdopPairTest, decltype(&sdop_pair_test_free)> test;
    btDefaultCollisionConfiguration configuration;
    CountingDispatcher dispatcher;
    btDbvtBroadphase broad_phase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broad_phase, &solver, &configuration};
    std::vector<std::unique_ptr<btTriangleIndexVertexArray>> meshes;
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;

    Scene(SdopPairTest* test, Mode mode) : test(test, sdop_pair_test_free), dispatcher(&configuration, test, mode) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
    }

    ~Scene() {
        for (auto& body : bodies) world.removeRigidBody(body.get());
    }

    btRigidBody& add(float mass, btCollisionShape* shape, const btTransform& pose, float restitution, float friction) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape->calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
        info.m_startWorldTransform = pose;
        info.m_restitution = restitution;
        info.m_friction = friction;
        bodies.push_back(std::make_unique<btRigidBody>(info));
        world.addRigidBody(bodies.back().get());
        return *bodies.back();
    }

    btCollisionShape* make(Kind kind, const float* vertices, size_t count, const uint32_t* triangles, size_t triangle_count) {
        if (kind == BALL) return new btSphereShape(0.5f);
        if (kind == MESH) {
            meshes.push_back(std::make_unique<btTriangleIndexVertexArray>(
                int(triangle_count), reinterpret_cast<int*>(const_cast<uint32_t*>(triangles)), int(3 * sizeof(uint32_t)), int(count),
                const_cast<float*>(vertices), int(3 * sizeof(float))));
            auto* mesh = new btGImpactMeshShape(meshes.back().get());
            mesh->setMargin(CONVEX_DISTANCE_MARGIN);
            mesh->updateBound();
            return mesh;
        }
        if (kind == BOX) {
            btVector3 half(0, 0, 0);
            for (size_t i = 0; i < count; i++) half.setMax(btVector3(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]).absolute());
            return new btBoxShape(half);
        }
        btConvexHullComputer hull;
        hull.compute(vertices, int(3 * sizeof(float)), int(count), 0, 0);
        auto* shape = new btConvexHullShape();
        for (int i = 0; i < hull.vertices.size(); i++) shape->addPoint(hull.vertices[i], false);
        shape->recalcLocalAabb();
        return shape;
    }
};

}  // namespace

extern "C" {

Scene* scene_new(uint32_t mode) {
    SdopPairTest* test = nullptr;
    sdop_pair_test_new(0, &test);
    return new Scene(test, Mode(mode));
}

void scene_free(Scene* scene) {
    delete scene;
}

void scene_gravity(Scene* scene, const float* gravity) {
    scene->world.setGravity(btVector3(gravity[0], gravity[1], gravity[2]));
    for (auto& body : scene->bodies) body->activate();
}

// The half-space n·x >= d stays free.
void scene_wall(Scene* scene, const float* normal, float d, float restitution) {
    scene->shapes.push_back(std::make_unique<btStaticPlaneShape>(btVector3(normal[0], normal[1], normal[2]), d));
    scene->add(0, scene->shapes.back().get(), btTransform::getIdentity(), restitution, 0.5f);
}

// A shape for bodies, about their origin. The arrays must outlive the scene.
uint32_t scene_shape(Scene* scene, uint32_t kind, const float* vertices, size_t count, const uint32_t* triangles, size_t triangle_count) {
    scene->shapes.emplace_back(scene->make(Kind(kind), vertices, count, triangles, triangle_count));
    return uint32_t(scene->shapes.size() - 1);
}

// The number that the filter knows the shape's mesh by, or -1: grown by what bodies of the default
// collision margin need, times `share`.
int scene_model(Scene* scene, uint32_t shape, const float (*vertices)[3], size_t count, const uint32_t (*triangles)[3],
                size_t triangle_count, float share) {
    const float margin = CullingDispatcher::margin(*scene->shapes[shape], CONVEX_DISTANCE_MARGIN) * share;
    return CullingDispatcher::add(scene->test.get(), vertices, count, triangles, triangle_count, margin);
}

// `motion`: quaternion, translation, velocity, spin. `model` is what `scene_model` gave, or -1.
void scene_body(Scene* scene, uint32_t shape, int model, const float* motion, float restitution, float friction) {
    const btTransform pose(btQuaternion(motion[0], motion[1], motion[2], motion[3]), btVector3(motion[4], motion[5], motion[6]));
    btRigidBody& body = scene->add(1, scene->shapes[shape].get(), pose, restitution, friction);
    body.setLinearVelocity(btVector3(motion[7], motion[8], motion[9]));
    body.setAngularVelocity(btVector3(motion[10], motion[11], motion[12]));
    body.setUserIndex3(model);
}

void scene_step(Scene* scene, float seconds) {
    scene->world.stepSimulation(seconds, 0);
}

Counts scene_counts(const Scene* scene) {
    return scene->dispatcher.counts;
}
}
