/* What a call costs beside its work: nanoseconds a call, the best of many rounds. */
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <toile.h>

enum { ROUNDS = 200, CALLS = 10000 };

static double now_ns(void)
{
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return 1e9 * (double)at.tv_sec + (double)at.tv_nsec;
}

#define MEASURE(name, call)                                          \
    do {                                                             \
        double best = 1e30;                                          \
        for (int round = 0; round < ROUNDS; round++) {               \
            double began = now_ns();                                 \
            for (int i = 0; i < CALLS; i++)                          \
                if (call)                                            \
                    failed++;                                        \
            double each = (now_ns() - began) / CALLS;                \
            best = each < best ? each : best;                        \
        }                                                            \
        printf("%-44s %8.1f ns\n", name, best);                      \
        worst = best > worst ? best : worst;                         \
    } while (0)

int main(void)
{
    float xyz[12] = {0, 1, 0, 0.1f, 1, 0, 0, 1.1f, 0, 0.1f, 1.1f, 0}, read[12];
    uint32_t triangles[] = {0, 1, 2, 1, 3, 2}, pins[] = {2, 3};
    toile_scene scene, null = {0};
    toile_body body;
    toile_clock clock;
    toile_body_mesh mesh;
    const float *lent;
    size_t count;
    uint64_t hash;
    long failed = 0;
    double worst = 0;
    if (toile_scene_of_mesh(xyz, 4, triangles, 2, pins, 2, "cotton-lawn", &scene) ||
        toile_body_from_measures(TOILE_SEX_FEMALE, NULL, 0, &body)) {
        fprintf(stderr, "overhead: %s\n", toile_last_error());
        return 1;
    }
    puts("a scene of 4 vertices, so that nearly all of it is the call itself:");
    MEASURE("toile_abi_version", toile_abi_version() != TOILE_ABI_VERSION);
    MEASURE("toile_body_mesh_of", toile_body_mesh_of(body, &mesh));
    MEASURE("toile_scene_clock", toile_scene_clock(scene, &clock));
    MEASURE("toile_scene_positions", toile_scene_positions(scene, 0, read, 4, &count));
    MEASURE("toile_scene_lend_positions", toile_scene_lend_positions(scene, 0, &lent, &count));
    MEASURE("toile_scene_state_hash", toile_scene_state_hash(scene, &hash));
    MEASURE("toile_scene_step of a null handle, refused", toile_scene_step(null) != TOILE_CODE_USAGE);
    toile_scene_close(scene);
    toile_body_close(body);
    printf("the worst of them: %.1f ns of 5000\n", worst);
    return failed != 0 || worst > 5000;
}
