/* A shirt on a body of measures: the size that fits, then a second of cloth, and where it is.
 *
 *     cc -std=c11 dressed.c $(pkg-config --cflags --libs toile) -o dressed && ./dressed
 */
#include <stdio.h>
#include <stdlib.h>
#include <toile.h>

/* What failed, if anything did. */
static void check(toile_code code)
{
    if (code != TOILE_CODE_OK) {
        fprintf(stderr, "dressed: %s\n", toile_last_error());
        exit((int)code);
    }
}

int main(int argc, char **argv)
{
    toile_given_measure mm[] = {{"stature", 1720}, {"chest", 920}, {"waist", 760}, {"hip", 1000}};
    toile_body body;
    toile_garment shirt;
    toile_fit fit;
    toile_fit_summary says;
    check(toile_body_from_measures(TOILE_SEX_FEMALE, mm, 4, &body));
    check(toile_garment_open(argc > 1 ? argv[1] : "tee", NULL, NULL, &shirt)); /* or "shirt.obj" */
    check(toile_recommend(body, shirt, &fit));
    check(toile_fit_read(fit, &says));
    printf("size %s: %s\n", says.size, says.verdict);
    for (size_t i = 0; i < says.zones; i++) {
        toile_zone zone;
        check(toile_fit_zone(fit, i, &zone));
        printf("  %s %+.0f mm: %s\n", zone.zone, zone.ease_mm, zone.verdict);
    }

    toile_scene scene;
    check(toile_scene_dress(body, &shirt, 1, NULL, &scene)); /* NULL: stands, in the quality of a shop */
    size_t vertices;
    check(toile_scene_positions(scene, 0, NULL, 0, &vertices)); /* how many */
    float *xyz = malloc(3 * vertices * sizeof *xyz);
    if (!xyz)
        return 1;
    check(toile_scene_step_many(scene, argc > 2 ? (uint64_t)atoi(argv[2]) : 120));
    check(toile_scene_positions(scene, 0, xyz, vertices, NULL));
    float lowest = xyz[1];
    for (size_t v = 0; v < vertices; v++)
        lowest = xyz[3 * v + 1] < lowest ? xyz[3 * v + 1] : lowest;
    uint64_t hash;
    check(toile_scene_state_hash(scene, &hash));
    printf("%zu vertices, the lowest at %.3f m, state %016llx\n", vertices, lowest, (unsigned long long)hash);

    free(xyz);
    check(toile_scene_close(scene));
    check(toile_fit_close(fit));
    check(toile_garment_close(shirt));
    check(toile_body_close(body));
    return 0;
}
