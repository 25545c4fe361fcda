/* A recording in: measures, the size, the scene at its end, a picture.
 *
 *     cc -std=c11 recorded.c $(pkg-config --cflags --libs toile) -o recorded && ./recorded [RECORDING]
 */
#include <stdio.h>
#include <stdlib.h>
#include <toile.h>

/* What failed, if anything did. */
static void check(toile_code code)
{
    if (code != TOILE_CODE_OK) {
        fprintf(stderr, "recorded: %s\n", toile_last_error());
        exit((int)code);
    }
}

int main(int argc, char **argv)
{
    toile_recording recording;
    toile_garment dress;
    if (argc > 1)
        check(toile_recording_open(argv[1], NULL, &recording)); /* MCAP, Kinect CSV, BVH, ... */
    else
        check(toile_recording_embedded(&recording));
    check(toile_garment_open("strap-dress", NULL, NULL, &dress));

    toile_try_on_options options = {0}; /* nothing is known of the person, quality shop */
    options.width = 120;
    options.height = 160;
    toile_try_on_result result;
    toile_try_on_facts facts;
    check(toile_try_on(recording, &dress, 1, &options, &result));
    check(toile_try_on_result_read(result, &facts));
    for (size_t i = 0; i < facts.measures; i++) {
        toile_measure measure;
        check(toile_try_on_result_measure(result, i, &measure));
        printf("%s: %.0f mm, sigma %.0f\n", measure.name, measure.mm, measure.sigma_mm);
    }

    static uint8_t front[4 * 120 * 160];
    check(toile_try_on_result_picture(result, TOILE_LOOK_FIT_MAP, 0, front, sizeof front, NULL));
    toile_scene scene;
    toile_worn_garment worn;
    check(toile_try_on_result_scene(result, &scene));
    check(toile_scene_garment(scene, 0, &worn));
    check(toile_scene_write_png(scene, TOILE_LOOK_FABRIC, 30, 300, 400, "recorded.png"));
    printf("%s in size %s, %zu vertices; the pixel in the middle is %d %d %d; see recorded.png\n", worn.name, worn.size,
           worn.vertices, front[4 * (80 * 120 + 60)], front[4 * (80 * 120 + 60) + 1], front[4 * (80 * 120 + 60) + 2]);

    check(toile_scene_close(scene));
    check(toile_try_on_result_close(result));
    check(toile_garment_close(dress));
    check(toile_recording_close(recording));
    return 0;
}
