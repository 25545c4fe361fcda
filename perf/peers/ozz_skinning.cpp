// Times ozz-animation's skinning job beside plain scalar loops that do the same work. Prints one JSON object.
#include "skirt_scene.h"

#include "ozz/base/maths/simd_math.h"
#include "ozz/geometry/runtime/skinning_job.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

constexpr int kVertices = 15000;
constexpr int kInfluences = 4;
constexpr int kBones = 60;

// Three rows: the turn, then the translation, of each row.
struct Matrix {
    float row[3][4];
};

// One tight buffer each, in the order of the mesh.
struct Mesh {
    std::vector<float> positions, normals;
    std::vector<std::uint16_t> bones;
    std::vector<float> weights;        // All four of a vertex.
    std::vector<float> first_weights;  // The first three: ozz has the last from their sum.
};

struct Skinned {
    std::vector<float> positions = std::vector<float>(3 * kVertices);
    std::vector<float> normals = std::vector<float>(3 * kVertices);
};

static Mesh make_mesh(std::mt19937 &random) {
    std::uniform_real_distribution<float> side(-1, 1), share(.05f, 1);
    std::uniform_int_distribution<int> bone(0, kBones - 1);
    Mesh mesh;
    for (int v = 0; v < kVertices; ++v) {
        float normal[3], squares = 0;
        for (float &n : normal) squares += (n = side(random)) * n;
        for (float n : normal) {
            mesh.positions.push_back(side(random));
            mesh.normals.push_back(n / std::sqrt(squares));
        }
        float weights[kInfluences], sum = 0;
        for (float &w : weights) sum += w = share(random);
        // The last weight is made as ozz makes it, so that both loops blend with the same four.
        float left = 1;
        for (int i = 0; i + 1 < kInfluences; ++i) left -= weights[i] /= sum;
        weights[kInfluences - 1] = left;
        mesh.weights.insert(mesh.weights.end(), weights, weights + kInfluences);
        mesh.first_weights.insert(mesh.first_weights.end(), weights, weights + kInfluences - 1);
        for (int i = 0; i < kInfluences; ++i) mesh.bones.push_back(std::uint16_t(bone(random)));
    }
    return mesh;
}

static std::vector<Matrix> make_palette(std::mt19937 &random) {
    std::uniform_real_distribution<double> angle(-scene::kPi, scene::kPi);
    std::uniform_real_distribution<float> offset(-1, 1);
    std::vector<Matrix> palette(kBones);
    for (Matrix &m : palette) {
        const double about_x = angle(random), about_y = angle(random);
        const scene::Vec axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int column = 0; column < 3; ++column) {
            const scene::Vec turned = scene::turn_y(about_y, scene::turn_x(about_x, axes[column]));
            m.row[0][column] = float(turned.x);
            m.row[1][column] = float(turned.y);
            m.row[2][column] = float(turned.z);
        }
        for (auto &row : m.row) row[3] = offset(random);
    }
    return palette;
}

static std::vector<ozz::math::Float4x4> ozz_palette(const std::vector<Matrix> &palette) {
    std::vector<ozz::math::Float4x4> out;
    for (const Matrix &m : palette) {
        ozz::math::Float4x4 columns;
        for (int c = 0; c < 4; ++c)
            columns.cols[c] =
                ozz::math::simd_float4::Load(m.row[0][c], m.row[1][c], m.row[2][c], c == 3 ? 1.0f : 0.0f);
        out.push_back(columns);
    }
    return out;
}

static ozz::geometry::SkinningJob make_job(const Mesh &mesh, const std::vector<ozz::math::Float4x4> &palette,
                                           Skinned &out) {
    ozz::geometry::SkinningJob job;
    job.vertex_count = kVertices;
    job.influences_count = kInfluences;
    job.joint_matrices = {palette.data(), palette.size()};
    job.joint_indices = {mesh.bones.data(), mesh.bones.size()};
    job.joint_indices_stride = kInfluences * sizeof(std::uint16_t);
    job.joint_weights = {mesh.first_weights.data(), mesh.first_weights.size()};
    job.joint_weights_stride = (kInfluences - 1) * sizeof(float);
    job.in_positions = {mesh.positions.data(), mesh.positions.size()};
    job.in_normals = {mesh.normals.data(), mesh.normals.size()};
    job.out_positions = {out.positions.data(), out.positions.size()};
    job.out_normals = {out.normals.data(), out.normals.size()};
    job.in_positions_stride = job.in_normals_stride = 3 * sizeof(float);
    job.out_positions_stride = job.out_normals_stride = 3 * sizeof(float);
    return job;
}

// Every influence moves the vertex, and the weighted sum is where it ends. Normals keep the length the sum gives them.
[[gnu::noinline]] static void blend(const Matrix *palette, const Mesh &mesh, Skinned &out) {
    for (int v = 0; v < kVertices; ++v) {
        const float *p = &mesh.positions[3 * v], *n = &mesh.normals[3 * v];
        float position[3] = {0, 0, 0}, normal[3] = {0, 0, 0};
        for (int i = 0; i < kInfluences; ++i) {
            const Matrix &m = palette[mesh.bones[kInfluences * v + i]];
            const float weight = mesh.weights[kInfluences * v + i];
            for (int axis = 0; axis < 3; ++axis) {
                const float *row = m.row[axis];
                position[axis] += weight * (row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]);
                normal[axis] += weight * (row[0] * n[0] + row[1] * n[1] + row[2] * n[2]);
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            out.positions[3 * v + axis] = position[axis];
            out.normals[3 * v + axis] = normal[axis];
        }
    }
}

// The same sum with the matrices blended first, and the vertex moved once.
[[gnu::noinline]] static void blend_matrices(const Matrix *palette, const Mesh &mesh, Skinned &out) {
    for (int v = 0; v < kVertices; ++v) {
        Matrix sum = {};
        for (int i = 0; i < kInfluences; ++i) {
            const Matrix &m = palette[mesh.bones[kInfluences * v + i]];
            const float weight = mesh.weights[kInfluences * v + i];
            for (int axis = 0; axis < 3; ++axis)
                for (int column = 0; column < 4; ++column) sum.row[axis][column] += weight * m.row[axis][column];
        }
        const float *p = &mesh.positions[3 * v], *n = &mesh.normals[3 * v];
        for (int axis = 0; axis < 3; ++axis) {
            const float *row = sum.row[axis];
            out.positions[3 * v + axis] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
            out.normals[3 * v + axis] = row[0] * n[0] + row[1] * n[1] + row[2] * n[2];
        }
    }
}

template <typename Work>
static double median_us(int repetitions, Work work) {
    std::vector<double> times;
    for (int i = 0; i < repetitions + repetitions / 10; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const auto end = std::chrono::steady_clock::now();
        // The first tenth more than was asked for warms up.
        if (i >= repetitions / 10) times.push_back(std::chrono::duration<double, std::micro>(end - start).count());
    }
    return scene::quantile(times, .5);
}

static double worst(const std::vector<float> &a, const std::vector<float> &b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::fabs(double(a[i]) - double(b[i])));
    return worst;
}

int main(int count, char **words) {
    int repetitions = 5000;
    if (count == 3 && std::strcmp(words[1], "--repetitions") == 0) repetitions = std::atoi(words[2]);
    if ((count != 1 && count != 3) || repetitions < 10) {
        std::fprintf(stderr, "options: --repetitions N, 10 or more\n");
        return 2;
    }
    std::mt19937 random(1);
    const Mesh mesh = make_mesh(random);
    const std::vector<Matrix> palette = make_palette(random);
    const std::vector<ozz::math::Float4x4> columns = ozz_palette(palette);
    Skinned by_ozz, by_loop, by_matrix;
    const ozz::geometry::SkinningJob job = make_job(mesh, columns, by_ozz);
    if (!job.Run()) {
        std::fprintf(stderr, "ozz refuses the job\n");
        return 1;
    }
    const double ozz_us = median_us(repetitions, [&] { job.Run(); });
    const double scalar_us = median_us(repetitions, [&] { blend(palette.data(), mesh, by_loop); });
    const double matrices_us = median_us(repetitions, [&] { blend_matrices(palette.data(), mesh, by_matrix); });
    std::printf("{\"engine\": \"ozz-animation\", \"version\": \"" OZZ_VERSION_TEXT "\", \"simd\": \"%s\", "
                "\"vertices\": %d, \"influences\": %d, \"bones\": %d, \"repetitions\": %d, \"us\": {\"p50\": %.2f}, "
                "\"scalar_us\": %.2f, \"scalar_matrices_us\": %.2f, \"max_error_m\": %.3g, \"max_error_normal\": %.3g}\n",
                ozz::math::SimdImplementationName(), kVertices, kInfluences, kBones, repetitions, ozz_us, scalar_us,
                matrices_us,
                std::max(worst(by_ozz.positions, by_loop.positions), worst(by_matrix.positions, by_loop.positions)),
                std::max(worst(by_ozz.normals, by_loop.normals), worst(by_matrix.normals, by_loop.normals)));
}
