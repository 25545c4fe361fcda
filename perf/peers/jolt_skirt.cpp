// Times Jolt's soft body on the skirt scene and measures how much it stretches. Prints one JSON object.
#include "skirt_scene.h"

#include <Jolt/Jolt.h>

#include <Jolt/ConfigurationString.h>
#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/JobSystemThreadPool.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayerInterfaceTable.h>
#include <Jolt/Physics/Collision/BroadPhase/ObjectVsBroadPhaseLayerFilterTable.h>
#include <Jolt/Physics/Collision/ObjectLayerPairFilterTable.h>
#include <Jolt/Physics/Collision/Shape/TaperedCapsuleShape.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/Physics/SoftBody/SoftBodyCreationSettings.h>
#include <Jolt/Physics/SoftBody/SoftBodyMotionProperties.h>
#include <Jolt/RegisterTypes.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

using Shared = JPH::SoftBodySharedSettings;

// Allocations through Jolt's own allocator.

static std::atomic<std::uint64_t> allocations{0};
static JPH::AllocateFunction plain_allocate;
static JPH::ReallocateFunction plain_reallocate;
static JPH::AlignedAllocateFunction plain_aligned_allocate;

static void count_allocations() {
    JPH::RegisterDefaultAllocator();
    plain_allocate = JPH::Allocate;
    plain_reallocate = JPH::Reallocate;
    plain_aligned_allocate = JPH::AlignedAllocate;
    JPH::Allocate = [](size_t size) { return ++allocations, plain_allocate(size); };
    JPH::Reallocate = [](void *block, size_t old_size, size_t size) {
        return ++allocations, plain_reallocate(block, old_size, size);
    };
    JPH::AlignedAllocate = [](size_t size, size_t alignment) {
        return ++allocations, plain_aligned_allocate(size, alignment);
    };
}

struct Options {
    int verts = 4096, iterations = 5, threads = 1, hz = 120, runs = 5, steps = 600;
    std::string motion = "walk", bend = "distance", lra = "geodesic";
    double compliance = 0;
    double shear_compliance = -1, bend_compliance = -1;  // Below 0: by the mass of a vertex.
};

[[noreturn]] static void refuse(const std::string &why) {
    std::fprintf(stderr,
                 "%s\noptions: --verts N (a square) --motion walk|fast|settled --iterations N --threads N "
                 "--hz 120|240|... --runs N --steps N --compliance X --shear-compliance X --bend-compliance X "
                 "--bend none|distance|dihedral --lra none|geodesic|euclidean\n",
                 why.c_str());
    std::exit(2);
}

static Options read_options(int count, char **words) {
    Options o;
    for (int i = 1; i < count; i += 2) {
        const std::string name = words[i];
        if (i + 1 == count) refuse(name + " has no value");
        const std::string value = words[i + 1];
        if (name == "--verts") o.verts = std::atoi(words[i + 1]);
        else if (name == "--iterations") o.iterations = std::atoi(words[i + 1]);
        else if (name == "--threads") o.threads = std::atoi(words[i + 1]);
        else if (name == "--hz") o.hz = std::atoi(words[i + 1]);
        else if (name == "--runs") o.runs = std::atoi(words[i + 1]);
        else if (name == "--steps") o.steps = std::atoi(words[i + 1]);
        else if (name == "--motion") o.motion = value;
        else if (name == "--bend") o.bend = value;
        else if (name == "--compliance") o.compliance = std::atof(words[i + 1]);
        else if (name == "--shear-compliance") o.shear_compliance = std::atof(words[i + 1]);
        else if (name == "--bend-compliance") o.bend_compliance = std::atof(words[i + 1]);
        else if (name == "--lra") o.lra = value;
        else refuse("unknown option " + name);
    }
    const int side = int(std::lround(std::sqrt(double(o.verts))));
    if (side < 4 || side * side != o.verts) refuse("--verts is not a square of 4 or more");
    if (o.hz < 120 || o.hz % 120 != 0) refuse("--hz is not a multiple of 120");
    if (o.iterations < 1 || o.threads < 1 || o.runs < 1 || o.steps < 1) refuse("a count is below 1");
    // Jolt's sample cloth has a compliance of 1e-5 at 1 kg a vertex; this is as stiff against a lighter vertex.
    const double like_sample = 1e-5 * o.verts / scene::kMass;
    if (o.shear_compliance < 0) o.shear_compliance = like_sample;
    if (o.bend_compliance < 0) o.bend_compliance = like_sample;
    return o;
}

static Shared::EBendType bend_type(const std::string &name) {
    if (name == "none") return Shared::EBendType::None;
    if (name == "distance") return Shared::EBendType::Distance;
    if (name == "dihedral") return Shared::EBendType::Dihedral;
    refuse("unknown --bend " + name);
}

static Shared::ELRAType lra_type(const std::string &name) {
    if (name == "none") return Shared::ELRAType::None;
    if (name == "geodesic") return Shared::ELRAType::GeodesicDistance;
    if (name == "euclidean") return Shared::ELRAType::EuclideanDistance;
    refuse("unknown --lra " + name);
}

static JPH::Vec3 jolt(scene::Vec p) { return JPH::Vec3(float(p.x), float(p.y), float(p.z)); }

static JPH::Ref<Shared> cloth_settings(const scene::Skirt &skirt, const Options &o) {
    JPH::Ref<Shared> shared = new Shared;
    const float inverse_mass = float(o.verts / scene::kMass);
    for (std::size_t v = 0; v < skirt.rest.size(); ++v) {
        Shared::Vertex vertex;
        jolt(skirt.rest[v]).StoreFloat3(&vertex.mPosition);
        vertex.mInvMass = v < std::size_t(skirt.side) ? 0.0f : inverse_mass;
        shared->mVertices.push_back(vertex);
    }
    for (const auto &t : skirt.triangles) shared->AddFace(Shared::Face(t[0], t[1], t[2]));
    const Shared::VertexAttributes attributes(float(o.compliance), float(o.shear_compliance), float(o.bend_compliance),
                                              lra_type(o.lra));
    shared->CreateConstraints(&attributes, 1, bend_type(o.bend));
    shared->Optimize();
    return shared;
}

// One tapered capsule of the body. Its axis is y in its own frame.
struct Capsule {
    int low, high;
    JPH::Quat rest;
    JPH::BodyID id;

    JPH::Vec3 position(const scene::Pose &pose) const { return jolt(.5 * (pose.joint[low] + pose.joint[high])); }

    // The turn of the body part that it belongs to, so that it does not also spin about its own axis.
    JPH::Quat rotation(const scene::Pose &pose) const {
        const JPH::Quat limb = JPH::Quat::sRotation(JPH::Vec3::sAxisX(), float(pose.limb[high]));
        return (JPH::Quat::sRotation(JPH::Vec3::sAxisY(), float(pose.yaw)) * limb * rest).Normalized();
    }
};

enum Layer : JPH::ObjectLayer { kBody, kCloth, kLayers };

class Stage {
public:
    explicit Stage(const Options &o)
        : options_(o), skirt_(int(std::lround(std::sqrt(double(o.verts))))), temp_(64 << 20),
          layers_(kLayers), broad_(kLayers, 2) {
        if (!scene::motion_from(o.motion, motion_)) refuse("unknown --motion " + o.motion);
        layers_.EnableCollision(kBody, kCloth);
        broad_.MapObjectToBroadPhaseLayer(kBody, JPH::BroadPhaseLayer(0));
        broad_.MapObjectToBroadPhaseLayer(kCloth, JPH::BroadPhaseLayer(1));
        object_vs_broad_ =
            std::make_unique<JPH::ObjectVsBroadPhaseLayerFilterTable>(broad_, 2, layers_, kLayers);
        if (o.threads == 1)
            jobs_ = std::make_unique<JPH::JobSystemSingleThreaded>(JPH::cMaxPhysicsJobs);
        else
            jobs_ = std::make_unique<JPH::JobSystemThreadPool>(JPH::cMaxPhysicsJobs, JPH::cMaxPhysicsBarriers,
                                                               o.threads - 1);
        system_.Init(64, 0, 256, 256, broad_, *object_vs_broad_, layers_);
        system_.SetGravity(JPH::Vec3(0, -float(scene::kGravity), 0));
        add_body();
        add_cloth();
        system_.OptimizeBroadPhase();
        now_.resize(skirt_.rest.size());
    }

    const scene::Skirt &skirt() const { return skirt_; }

    // Where the last step ended: the cloth, and the body.
    const std::vector<scene::Vec> &positions() {
        const auto &vertices = cloth()->GetVertices();
        for (std::size_t v = 0; v < now_.size(); ++v) {
            const JPH::Vec3 p = vertices[v].mPosition;
            now_[v] = {p.GetX(), p.GetY(), p.GetZ()};
        }
        return now_;
    }
    const scene::Pose &pose() const { return pose_; }

    std::size_t edges() { return cloth()->GetSettings()->mEdgeConstraints.size(); }
    std::size_t dihedrals() { return cloth()->GetSettings()->mDihedralBendConstraints.size(); }
    std::size_t attachments() { return cloth()->GetSettings()->mLRAConstraints.size(); }

    // Asks body and pinned ring to be where the scene has them at the end of the coming step. Not timed.
    void prepare() {
        tick_ += 1;
        pose_ = scene::pose(motion_, double(tick_) * scene::kStep);
        for (const Capsule &c : capsules_)
            system_.GetBodyInterfaceNoLock().MoveKinematic(c.id, c.position(pose_), c.rotation(pose_),
                                                           float(scene::kStep));
        // Jolt moves a vertex without mass by its velocity only.
        auto &vertices = cloth()->GetVertices();
        for (int j = 0; j < skirt_.side; ++j) {
            const JPH::Vec3 goal = jolt(pose_.place(skirt_.rest[j]));
            vertices[j].mVelocity = (goal - vertices[j].mPosition) / float(scene::kStep);
        }
    }

    // One step of 1/120 s; the time it took in microseconds.
    double step() {
        const auto start = std::chrono::steady_clock::now();
        const JPH::EPhysicsUpdateError error =
            system_.Update(float(scene::kStep), options_.hz / 120, &temp_, jobs_.get());
        const auto end = std::chrono::steady_clock::now();
        if (error != JPH::EPhysicsUpdateError::None) {
            std::fprintf(stderr, "the update failed with %u\n", unsigned(error));
            std::exit(1);
        }
        return std::chrono::duration<double, std::micro>(end - start).count();
    }

private:
    void add_body() {
        const scene::Pose start = scene::pose(motion_, 0);
        for (const auto &[low, high] : scene::capsules()) {
            const scene::Joint &a = scene::joints()[low], &b = scene::joints()[high];
            const JPH::Vec3 axis = jolt(b.at - a.at);
            Capsule capsule{low, high, JPH::Quat::sFromTo(JPH::Vec3::sAxisY(), axis.Normalized()), {}};
            // Where one sphere holds the other, these settings make a sphere.
            const JPH::TaperedCapsuleShapeSettings settings(.5f * axis.Length(), float(b.radius), float(a.radius));
            JPH::BodyCreationSettings body(settings.Create().Get(), capsule.position(start), capsule.rotation(start),
                                           JPH::EMotionType::Kinematic, kBody);
            body.mFriction = float(scene::kFriction);
            body.mAllowSleeping = false;
            capsule.id = system_.GetBodyInterface().CreateAndAddBody(body, JPH::EActivation::Activate);
            capsules_.push_back(capsule);
        }
    }

    void add_cloth() {
        JPH::SoftBodyCreationSettings body(cloth_settings(skirt_, options_), JPH::RVec3::sZero(),
                                           JPH::Quat::sIdentity(), kCloth);
        body.mNumIterations = std::uint32_t(options_.iterations);
        body.mFriction = float(scene::kFriction);
        // dv/dt = -c v, and a second leaves 35 % of the velocity: c = -ln .35.
        body.mLinearDamping = float(-std::log(1 - .65));
        // Keeps the vertices in world coordinates; the body's own position plays no part.
        body.mUpdatePosition = false;
        body.mAllowSleeping = false;
        cloth_ = system_.GetBodyInterface().CreateAndAddSoftBody(body, JPH::EActivation::Activate);
    }

    JPH::SoftBodyMotionProperties *cloth() {
        JPH::Body *body = system_.GetBodyLockInterfaceNoLock().TryGetBody(cloth_);
        return static_cast<JPH::SoftBodyMotionProperties *>(body->GetMotionProperties());
    }

    Options options_;
    scene::Skirt skirt_;
    scene::Motion motion_ = scene::Motion::walk;
    JPH::TempAllocatorImpl temp_;
    JPH::ObjectLayerPairFilterTable layers_;
    JPH::BroadPhaseLayerInterfaceTable broad_;
    std::unique_ptr<JPH::ObjectVsBroadPhaseLayerFilterTable> object_vs_broad_;
    std::unique_ptr<JPH::JobSystem> jobs_;
    JPH::PhysicsSystem system_;
    std::vector<Capsule> capsules_;
    JPH::BodyID cloth_;
    scene::Pose pose_;
    std::vector<scene::Vec> now_;
    std::uint64_t tick_ = 0;
};

struct Times {
    std::vector<double> steps, run_medians;
    double allocations = 0;  // A step.
};

static Times run(Stage &stage, scene::Gauge &gauge, const Options &o) {
    for (int i = 0; i < scene::kWarmUp; ++i) {
        stage.prepare();
        stage.step();
    }
    Times times;
    std::uint64_t made = 0;
    for (int r = 0; r < o.runs; ++r) {
        std::vector<double> of_run;
        for (int i = 0; i < o.steps; ++i) {
            stage.prepare();
            const std::uint64_t before = allocations;
            of_run.push_back(stage.step());
            made += allocations - before;
            gauge.read(stage.positions(), stage.pose());
        }
        times.run_medians.push_back(scene::quantile(of_run, .5));
        times.steps.insert(times.steps.end(), of_run.begin(), of_run.end());
    }
    times.allocations = double(made) / double(times.steps.size());
    return times;
}

static void print(Stage &stage, const Options &o, const Times &t, const scene::Measures &m) {
    std::printf("{\"engine\": \"Jolt Physics\", \"version\": \"%d.%d.%d\", \"build\": \"%s\", ", JPH_VERSION_MAJOR,
                JPH_VERSION_MINOR, JPH_VERSION_PATCH, JPH::GetConfigurationString());
    std::printf("\"options\": {\"verts\": %d, \"motion\": \"%s\", \"iterations\": %d, \"threads\": %d, \"hz\": %d, "
                "\"runs\": %d, \"steps\": %d, \"compliance\": %g, \"shear_compliance\": %g, \"bend\": \"%s\", "
                "\"bend_compliance\": %g, \"lra\": \"%s\"}, ",
                o.verts, o.motion.c_str(), o.iterations, o.threads, o.hz, o.runs, o.steps, o.compliance,
                o.shear_compliance, o.bend.c_str(), o.bend_compliance, o.lra.c_str());
    std::printf("\"edges\": %zu, \"dihedrals\": %zu, \"attachments\": %zu, ", stage.edges(), stage.dihedrals(),
                stage.attachments());
    std::printf("\"step_us\": {\"p50\": %.1f, \"p99\": %.1f}, \"run_p50_us\": [", scene::quantile(t.run_medians, .5),
                scene::quantile(t.steps, .99));
    for (std::size_t i = 0; i < t.run_medians.size(); ++i) std::printf("%s%.1f", i ? ", " : "", t.run_medians[i]);
    std::printf("], \"strain\": {\"mean\": %.6f, \"p99\": %.6f, \"max\": %.6f, \"compression_max\": %.6f}, ",
                m.strain_mean, m.strain_p99, m.stretch_max, m.compression_max);
    std::printf("\"penetration_mm\": {\"max\": %.3f, \"fraction\": %.6f}, ", 1e3 * m.deepest, m.inside);
    std::printf("\"hem_above_ring_m\": {\"lowest\": %.3f, \"highest\": %.3f}, ", m.hem_lowest, m.hem_highest);
    std::printf("\"nonfinite\": %zu, \"allocations_per_step\": %.1f}\n", m.nonfinite, t.allocations);
}

int main(int count, char **words) {
    const Options options = read_options(count, words);
    count_allocations();
    JPH::Factory::sInstance = new JPH::Factory;
    JPH::RegisterTypes();
    {
        Stage stage(options);
        scene::Gauge gauge(stage.skirt());
        const Times times = run(stage, gauge, options);
        print(stage, options, times, gauge.result());
    }
    JPH::UnregisterTypes();
    delete JPH::Factory::sInstance;
    JPH::Factory::sInstance = nullptr;
}
