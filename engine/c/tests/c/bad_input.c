/* Every call with null, NaN, wrong numbers, closed handles and from two threads: an error that says what, nothing lost, no crash. */
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <toile.h>

static int faults;

/* That a call is refused with a code and a sentence that names the call and has a word in it. */
static void refused(const char *call, int line, toile_code code, toile_code wanted, const char *word)
{
    const char *said = toile_last_error();
    size_t name = strcspn(call, " (");
    if (code != wanted || strncmp(said, call, name) != 0 || !strstr(said, word) || strchr(said, '\n')) {
        fprintf(stderr, "bad_input.c:%d: %s gave %d, \"%s\"; wanted %d with \"%s\"\n", line, call, (int)code, said, (int)wanted, word);
        faults++;
    }
}

static void done(const char *call, int line, toile_code code)
{
    if (code != TOILE_CODE_OK) {
        fprintf(stderr, "bad_input.c:%d: %s failed with %d: %s\n", line, call, (int)code, toile_last_error());
        faults++;
    }
}

static void holds(const char *what, int line, int is)
{
    if (!is) {
        fprintf(stderr, "bad_input.c:%d: it does not hold that %s\n", line, what);
        faults++;
    }
}

#define USAGE(call, word) refused(#call, __LINE__, call, TOILE_CODE_USAGE, word)
#define INPUT(call, word) refused(#call, __LINE__, call, TOILE_CODE_INPUT, word)
#define DEVICE(call, word) refused(#call, __LINE__, call, TOILE_CODE_DEVICE, word)
#define DONE(call) done(#call, __LINE__, call)
#define HOLDS(what) holds(#what, __LINE__, what)

static const char NO_UTF8[] = "shirt\xff";

static void names(void)
{
    uint8_t rgb[3];
    HOLDS(strcmp(toile_last_error(), "") == 0);
    HOLDS(strchr(toile_version(), '.') != NULL);
    HOLDS(toile_abi_version() == TOILE_ABI_VERSION);
    HOLDS(toile_name(TOILE_NAME_LIST_GARMENTS, 0) != NULL);
    HOLDS(toile_name(TOILE_NAME_LIST_MEASURES, 100000) == NULL);
    HOLDS(toile_name(17, 0) == NULL && strstr(toile_last_error(), "toile_name_list") != NULL);
    HOLDS(toile_name(-1, (size_t)-1) == NULL);
    DONE(toile_fit_colour(NAN, rgb));
    HOLDS(rgb[0] == 128);
    DONE(toile_fit_colour(INFINITY, rgb));
    USAGE(toile_fit_colour(0.0f, NULL), "null");
}

static void bodies(toile_garment garment)
{
    toile_given_measure fine[] = {{"chest", 920}}, twice[] = {{"chest", 920}, {"bust", 920}}, centimetres[] = {{"chest", 92}};
    toile_given_measure nan_mm[] = {{"chest", NAN}}, huge[] = {{"chest", 1e300}}, nameless[] = {{NULL, 920}};
    toile_given_measure strange[] = {{NO_UTF8, 920}}, unknown[] = {{"elbow", 920}};
    toile_body body = {17}, null = {0}, invented = {12345678901234567ULL}, other;
    toile_body_mesh mesh;
    const char *name;
    double mm;
    size_t count;
    char text[4];
    USAGE(toile_body_from_measures(TOILE_SEX_FEMALE, fine, 1, NULL), "null");
    USAGE(toile_body_from_measures(TOILE_SEX_UNKNOWN, fine, 1, &body), "TOILE_SEX_FEMALE");
    HOLDS(body.id == 0);
    USAGE(toile_body_from_measures(-5, fine, 1, &body), "-5");
    USAGE(toile_body_from_measures(TOILE_SEX_MALE, NULL, 1, &body), "measures is null");
    USAGE(toile_body_from_measures(TOILE_SEX_MALE, fine, (size_t)-1, &body), "negative");
    USAGE(toile_body_from_measures(TOILE_SEX_MALE, (toile_given_measure *)((char *)fine + 1), 1, &body), "multiple of 8");
    USAGE(toile_body_from_measures(TOILE_SEX_FEMALE, nameless, 1, &body), "name of a measure is null");
    INPUT(toile_body_from_measures(TOILE_SEX_FEMALE, strange, 1, &body), "UTF-8");
    INPUT(toile_body_from_measures(TOILE_SEX_FEMALE, twice, 2, &body), "twice");
    INPUT(toile_body_from_measures(TOILE_SEX_FEMALE, centimetres, 1, &body), "centimetres");
    INPUT(toile_body_from_measures(TOILE_SEX_FEMALE, nan_mm, 1, &body), "chest_girth");
    INPUT(toile_body_from_measures(TOILE_SEX_FEMALE, huge, 1, &body), "chest_girth");
    INPUT(toile_body_from_measures(TOILE_SEX_FEMALE, unknown, 1, &body), "elbow");
    INPUT(toile_body_open("there-is-no-such.glb", TOILE_SEX_MALE, &body), "there-is-no-such.glb");
    USAGE(toile_body_open(NULL, TOILE_SEX_MALE, &body), "null");
    USAGE(toile_body_open("there-is-no-such.glb", TOILE_SEX_MALE, NULL), "null");
    USAGE(toile_body_open("there-is-no-such.glb", 9, &body), "9");

    DONE(toile_body_from_measures(TOILE_SEX_FEMALE, NULL, 0, &body));
    USAGE(toile_body_measure_mm(null, "chest", &mm), "null handle");
    USAGE(toile_body_measure_mm(body, NULL, &mm), "null");
    USAGE(toile_body_measure_mm(body, "chest", NULL), "null");
    INPUT(toile_body_measure_mm(body, "elbow", &mm), "elbow");
    USAGE(toile_body_measure_count(body, NULL), "null");
    USAGE(toile_body_measure_count(invented, &count), "never");
    DONE(toile_body_measure_count(body, &count));
    USAGE(toile_body_measure(body, count, &name, &mm), "there is no measure");
    USAGE(toile_body_measure(body, 0, NULL, &mm), "null");
    USAGE(toile_body_measure(body, 0, &name, NULL), "null");
    USAGE(toile_body_mesh_of(body, NULL), "null");
    USAGE(toile_body_mesh_of(null, &mesh), "null handle");
    USAGE(toile_body_notes(body, NULL, 0, NULL), "neither");
    USAGE(toile_body_notes(body, text, 0, NULL), "room for 0");
    USAGE(toile_body_notes(body, NULL, 4, &count), "null");

    memcpy(&other, &garment, sizeof other);
    USAGE(toile_body_mesh_of(other, &mesh), "that of a garment");
    USAGE(toile_body_close(other), "takes a body");
    DONE(toile_body_close(null));
    USAGE(toile_body_close(invented), "never");
    DONE(toile_body_close(body));
    USAGE(toile_body_close(body), "closed before");
    USAGE(toile_body_mesh_of(body, &mesh), "closed before");
    USAGE(toile_body_measure_count(body, &count), "closed before");
    USAGE(toile_body_measure(body, 0, &name, &mm), "closed before");
    USAGE(toile_body_notes(body, text, 4, &count), "closed before");
    DONE(toile_body_from_measures(TOILE_SEX_MALE, NULL, 0, &other));
    HOLDS(other.id != body.id);
    USAGE(toile_body_measure_mm(body, "chest", &mm), "closed before");
    DONE(toile_body_close(other));
}

static void garments(void)
{
    toile_garment garment, null = {0};
    char text[2];
    size_t needed;
    USAGE(toile_garment_open(NULL, NULL, NULL, &garment), "null");
    USAGE(toile_garment_open("tee", NULL, NULL, NULL), "null");
    INPUT(toile_garment_open(NO_UTF8, NULL, NULL, &garment), "UTF-8");
    INPUT(toile_garment_open("sun-drses", NULL, NULL, &garment), "strap-dress");
    INPUT(toile_garment_open("tee", "gigantic", NULL, &garment), "gigantic");
    INPUT(toile_garment_open("tee", NULL, "coton-lawn", &garment), "cotton-lawn");
    INPUT(toile_garment_open("tee", NO_UTF8, NULL, &garment), "size");
    HOLDS(garment.id == 0);
    DONE(toile_garment_open("tee", NULL, NULL, &garment));
    DONE(toile_garment_sizes(garment, NULL, 0, &needed));
    HOLDS(needed > 2);
    USAGE(toile_garment_sizes(garment, text, sizeof text, NULL), "room for 2");
    USAGE(toile_garment_fabric(garment, text, sizeof text, &needed), "room for 2");
    USAGE(toile_garment_sizes(null, text, sizeof text, NULL), "null handle");
    DONE(toile_garment_close(garment));
    USAGE(toile_garment_close(garment), "closed before");
    USAGE(toile_garment_fabric(garment, text, sizeof text, &needed), "closed before");
}

static void fits(toile_body body, toile_garment garment)
{
    toile_fit fit, null = {0};
    toile_fit_summary says;
    toile_zone zone;
    toile_size_chance size;
    toile_body no_body = {0};
    toile_garment no_garment = {0};
    USAGE(toile_recommend(no_body, garment, &fit), "body is a null handle");
    USAGE(toile_recommend(body, no_garment, &fit), "garment is a null handle");
    USAGE(toile_recommend(body, garment, NULL), "null");
    HOLDS(fit.id == 0);
    DONE(toile_recommend(body, garment, &fit));
    USAGE(toile_fit_read(fit, NULL), "null");
    USAGE(toile_fit_read(null, &says), "null handle");
    DONE(toile_fit_read(fit, &says));
    USAGE(toile_fit_zone(fit, says.zones, &zone), "there is no zone");
    USAGE(toile_fit_zone(fit, 0, NULL), "null");
    USAGE(toile_fit_size(fit, (size_t)-1, &size), "there is no size");
    USAGE(toile_fit_size(fit, 0, NULL), "null");
    DONE(toile_fit_close(fit));
    USAGE(toile_fit_close(fit), "closed before");
    USAGE(toile_fit_read(fit, &says), "closed before");
    USAGE(toile_fit_zone(fit, 0, &zone), "closed before");
    USAGE(toile_fit_size(fit, 0, &size), "closed before");
}

/* A square of cloth of 9 x 9 vertices, held at two corners. */
static float square[3 * 81];
static uint32_t halves[3 * 128];
static const uint32_t corners[] = {0, 8};

static toile_scene flag(void)
{
    toile_scene scene;
    size_t at = 0;
    for (int i = 0; i < 81; i++) {
        square[3 * i] = 0.02f * (float)(i % 9);
        square[3 * i + 1] = 1.5f - 0.02f * (float)(i / 9);
        square[3 * i + 2] = 0;
    }
    for (uint32_t i = 0; i < 72; i++) {
        if (i % 9 == 8)
            continue;
        uint32_t two[] = {i, i + 9, i + 1, i + 1, i + 9, i + 10};
        memcpy(halves + at, two, sizeof two);
        at += 6;
    }
    DONE(toile_scene_of_mesh(square, 81, halves, 128, corners, 2, "cotton-lawn", &scene));
    return scene;
}

static void making_scenes(toile_body body, toile_garment garment)
{
    toile_scene scene;
    toile_body no_body = {0};
    toile_garment several[40], one_null[] = {garment, {0}};
    toile_joints unseen, broken;
    toile_wind storm = {{NAN, 0, 0}, 0.1f, 0.1f};
    const char *socks[] = {"socks"}, *none[] = {NULL};
    toile_file nameless = {NULL, NULL, 0}, missing = {"flag.obj", NULL, 12};
    uint32_t wrong[] = {0, 1, 81}, far[] = {81};
    float nan_xyz[9] = {0, 1, 0, 0.1f, NAN, 0, 0.1f, 1.1f, 0};
    for (int i = 0; i < 40; i++)
        several[i] = garment;
    memset(&unseen, 0, sizeof unseen);
    memset(&broken, 0xff, sizeof broken);

    USAGE(toile_scene_dress(no_body, &garment, 1, NULL, &scene), "body is a null handle");
    USAGE(toile_scene_dress(body, NULL, 1, NULL, &scene), "garments is null");
    USAGE(toile_scene_dress(body, one_null, 2, NULL, &scene), "garment is a null handle");
    USAGE(toile_scene_dress(body, &garment, 1, NULL, NULL), "null");
    USAGE(toile_scene_dress(body, &garment, (size_t)-1, NULL, &scene), "negative");
    INPUT(toile_scene_dress(body, several, 40, NULL, &scene), "40 garments");
    HOLDS(scene.id == 0);
#define DRESS(...) toile_scene_dress(body, &garment, 1, &(toile_dress_options){__VA_ARGS__}, &scene)
    USAGE(toile_scene_dress(body, &garment, 1, &(toile_dress_options){.motion = 9}, &scene), "no motion");
    USAGE(toile_scene_dress(body, &garment, 1, &(toile_dress_options){.quality = -1}, &scene), "no quality");
    INPUT(toile_scene_dress(body, &garment, 1, &(toile_dress_options){.workers = 3}, &scene), "3 workers");
    INPUT(toile_scene_dress(body, &garment, 1, &(toile_dress_options){.wind = &storm}, &scene), "wind");
    USAGE(toile_scene_dress(body, &garment, 1, &(toile_dress_options){.tuck_count = 1}, &scene), "tuck in is null");
    refused("toile_scene_dress", __LINE__, DRESS(.tuck = none, .tuck_count = 1), TOILE_CODE_USAGE, "null");
    refused("toile_scene_dress", __LINE__, DRESS(.tuck = socks, .tuck_count = 1), TOILE_CODE_INPUT, "socks");
    refused("toile_scene_dress", __LINE__, DRESS(.joints = &unseen, .joint_frames = 1), TOILE_CODE_USAGE, "stands or sits");
    refused("toile_scene_dress", __LINE__, DRESS(.motion = 2), TOILE_CODE_USAGE, "one frame");
    refused("toile_scene_dress", __LINE__, DRESS(.motion = 3), TOILE_CODE_INPUT, "track");
    refused("toile_scene_dress", __LINE__, DRESS(.motion = 2, .joints = &unseen, .joint_frames = 1), TOILE_CODE_INPUT, "hips");
    refused("toile_scene_dress", __LINE__, DRESS(.motion = 2, .joints = &broken, .joint_frames = 1), TOILE_CODE_INPUT, "finite");

    INPUT(toile_scene_open("there-is-no-such.toml", &scene), "there-is-no-such.toml");
    USAGE(toile_scene_open(NULL, &scene), "null");
    USAGE(toile_scene_open("there-is-no-such.toml", NULL), "null");
    INPUT(toile_scene_parse("mine", "duraton = 1", NULL, 0, &scene), "mine");
    INPUT(toile_scene_parse("mine", "[garment]\nmesh = \"flag.obj\"\n", NULL, 0, &scene), "flag.obj");
    USAGE(toile_scene_parse("mine", NULL, NULL, 0, &scene), "text is null");
    USAGE(toile_scene_parse(NULL, "duration = 1", NULL, 0, &scene), "name is null");
    USAGE(toile_scene_parse("mine", "duration = 1", &nameless, 1, &scene), "null");
    USAGE(toile_scene_parse("mine", "duration = 1", &missing, 1, &scene), "bytes of a file is null");
    USAGE(toile_scene_parse("mine", "duration = 1", NULL, 0, NULL), "null");

    DONE(toile_scene_close(flag()));
    USAGE(toile_scene_of_mesh(NULL, 81, halves, 128, corners, 2, "cotton-lawn", &scene), "vertices is null");
    USAGE(toile_scene_of_mesh(square, 81, NULL, 128, corners, 2, "cotton-lawn", &scene), "triangles is null");
    USAGE(toile_scene_of_mesh(square, 81, halves, 128, NULL, 2, "cotton-lawn", &scene), "pins is null");
    USAGE(toile_scene_of_mesh(square, 81, halves, 128, corners, 2, NULL, &scene), "fabric is null");
    USAGE(toile_scene_of_mesh(square, 81, halves, 128, corners, 2, "cotton-lawn", NULL), "null");
    USAGE(toile_scene_of_mesh(square, (size_t)-1, halves, 128, corners, 2, "cotton-lawn", &scene), "more vertices");
    INPUT(toile_scene_of_mesh(square, 81, halves, 128, corners, 2, "coton-lawn", &scene), "coton-lawn");
    INPUT(toile_scene_of_mesh(square, 81, wrong, 1, corners, 2, "cotton-lawn", &scene), "triangle 0");
    INPUT(toile_scene_of_mesh(square, 81, halves, 128, far, 1, "cotton-lawn", &scene), "81");
    INPUT(toile_scene_of_mesh(nan_xyz, 3, (uint32_t[]){0, 1, 2}, 1, NULL, 0, "cotton-lawn", &scene), "vertex 1");
    INPUT(toile_scene_of_mesh(NULL, 0, NULL, 0, NULL, 0, "cotton-lawn", &scene), "");
    HOLDS(scene.id == 0);
}

/* Every call that reads or steps a scene, of one that is refused. */
static void every_call(toile_scene scene, const char *why)
{
    toile_clock clock;
    toile_worn_garment worn;
    toile_garment_stats stats;
    toile_joints joints;
    toile_snapshot snapshot;
    toile_fit fit;
    const float *lent;
    float xyz[3];
    uint32_t faces[3];
    uint64_t hash;
    size_t count;
    uint8_t rgba[4 * 16 * 16];
    char text[8];
    memset(&joints, 0, sizeof joints);
    USAGE(toile_scene_step(scene), why);
    USAGE(toile_scene_step_many(scene, 1), why);
    USAGE(toile_scene_step_to(scene, &joints), why);
    USAGE(toile_scene_clock(scene, &clock), why);
    USAGE(toile_scene_garment_count(scene, &count), why);
    USAGE(toile_scene_garment(scene, 0, &worn), why);
    USAGE(toile_scene_fit(scene, 0, &fit), why);
    USAGE(toile_scene_positions(scene, 0, xyz, 1, &count), why);
    USAGE(toile_scene_lend_positions(scene, 0, &lent, &count), why);
    USAGE(toile_scene_normals(scene, 0, xyz, 1, &count), why);
    USAGE(toile_scene_faces(scene, 0, faces, 1, &count), why);
    USAGE(toile_scene_pinned(scene, 0, faces, 3, &count), why);
    USAGE(toile_scene_fit_map(scene, 0, xyz, 3, &count), why);
    USAGE(toile_scene_stats(scene, 0, &stats), why);
    USAGE(toile_scene_body(scene, xyz, NULL, 1, &count), why);
    USAGE(toile_scene_body_faces(scene, faces, 1, &count), why);
    USAGE(toile_scene_state_hash(scene, &hash), why);
    USAGE(toile_scene_warnings(scene, text, sizeof text, &count), why);
    USAGE(toile_scene_notes(scene, 0, text, sizeof text, &count), why);
    USAGE(toile_scene_picture(scene, TOILE_LOOK_FABRIC, 0, 16, 16, rgba, sizeof rgba), why);
    USAGE(toile_scene_write_png(scene, TOILE_LOOK_FABRIC, 0, 16, 16, "never.png"), why);
    USAGE(toile_scene_snapshot(scene, &snapshot), why);
}

static void null_places(toile_scene scene)
{
    USAGE(toile_scene_step_to(scene, NULL), "joints is null");
    USAGE(toile_scene_clock(scene, NULL), "null");
    USAGE(toile_scene_garment_count(scene, NULL), "null");
    USAGE(toile_scene_garment(scene, 0, NULL), "null");
    USAGE(toile_scene_fit(scene, 0, NULL), "null");
    USAGE(toile_scene_positions(scene, 0, NULL, 0, NULL), "neither");
    USAGE(toile_scene_positions(scene, 0, NULL, 81, NULL), "null");
    USAGE(toile_scene_lend_positions(scene, 0, NULL, NULL), "null");
    USAGE(toile_scene_normals(scene, 0, NULL, 0, NULL), "neither");
    USAGE(toile_scene_faces(scene, 0, NULL, 0, NULL), "neither");
    USAGE(toile_scene_pinned(scene, 0, NULL, 0, NULL), "neither");
    USAGE(toile_scene_stats(scene, 0, NULL), "null");
    USAGE(toile_scene_state_hash(scene, NULL), "null");
    USAGE(toile_scene_warnings(scene, NULL, 0, NULL), "neither");
    USAGE(toile_scene_notes(scene, 0, NULL, 0, NULL), "neither");
    USAGE(toile_scene_picture(scene, TOILE_LOOK_FABRIC, 0, 16, 16, NULL, 4 * 16 * 16), "null");
    USAGE(toile_scene_write_png(scene, TOILE_LOOK_FABRIC, 0, 16, 16, NULL), "null");
    USAGE(toile_scene_snapshot(scene, NULL), "null");
}

static void reading_scenes(toile_scene scene)
{
    static float xyz[3 * 81];
    static uint32_t faces[3 * 128];
    uint8_t rgba[4 * 16 * 16];
    char text[8];
    toile_garment_stats stats;
    toile_worn_garment worn;
    toile_joints joints;
    toile_fit fit;
    const float *lent;
    size_t count;
    uint64_t before, after;
    memset(&joints, 0, sizeof joints);
    DONE(toile_scene_step_many(scene, 5));
    DONE(toile_scene_state_hash(scene, &before));
    null_places(scene);
    USAGE(toile_scene_garment(scene, 1, &worn), "no garment 1");
    USAGE(toile_scene_fit(scene, 0, &fit), "has_fit");
    USAGE(toile_scene_positions(scene, (size_t)-1, xyz, 81, &count), "no garment");
    USAGE(toile_scene_positions(scene, 0, xyz, 80, &count), "room for 80 vertices, and there are 81");
    HOLDS(count == 81);
    USAGE(toile_scene_positions(scene, 0, (float *)((char *)xyz + 1), 81, &count), "multiple of 4");
    USAGE(toile_scene_lend_positions(scene, 1, &lent, &count), "no garment 1");
    USAGE(toile_scene_normals(scene, 0, xyz, 1, &count), "room for 1");
    USAGE(toile_scene_faces(scene, 0, faces, 127, &count), "room for 127 triangles, and there are 128");
    USAGE(toile_scene_pinned(scene, 0, faces, 1, &count), "room for 1 vertices, and there are 2");
    USAGE(toile_scene_stats(scene, 2, &stats), "no garment 2");
    USAGE(toile_scene_notes(scene, 2, text, 1, &count), "no garment 2");
    USAGE(toile_scene_warnings(scene, text, 0, &count), "room for 0");
    USAGE(toile_scene_fit_map(scene, 0, xyz, 81, &count), "no body");
    USAGE(toile_scene_body(scene, xyz, xyz, 81, &count), "no body");
    USAGE(toile_scene_body_faces(scene, faces, 81, &count), "no body");
    USAGE(toile_scene_step_to(scene, &joints), "no body");
    USAGE(toile_scene_step_many(scene, (uint64_t)-1), "negative");
    USAGE(toile_scene_picture(scene, 9, 0, 16, 16, rgba, sizeof rgba), "no look");
    INPUT(toile_scene_picture(scene, TOILE_LOOK_FABRIC, NAN, 16, 16, rgba, sizeof rgba), "finite");
    USAGE(toile_scene_picture(scene, TOILE_LOOK_FIT_MAP, 0, 16, 16, rgba, sizeof rgba), "no body");
    USAGE(toile_scene_picture(scene, TOILE_LOOK_FABRIC, 0, 0, 16, rgba, sizeof rgba), "0 x 16");
    USAGE(toile_scene_picture(scene, TOILE_LOOK_FABRIC, 0, 17, 16, rgba, sizeof rgba), "room for 1024");
    USAGE(toile_scene_picture(scene, TOILE_LOOK_FABRIC, 0, (uint32_t)-1, (uint32_t)-1, rgba, sizeof rgba), "room for 1024");
    DEVICE(toile_scene_write_png(scene, TOILE_LOOK_FABRIC, 0, 16, 16, "there-is-no-such-folder/a.png"), "there-is-no-such-folder");
    DONE(toile_scene_state_hash(scene, &after));
    HOLDS(before == after);

    toile_scene null = {0};
    every_call(null, "null handle");
    HOLDS(toile_scene_close(null) == TOILE_CODE_OK);
    DONE(toile_scene_positions(scene, 0, xyz, 81, &count));
    DONE(toile_scene_lend_positions(scene, 0, &lent, &count));
    HOLDS(memcmp(lent, xyz, sizeof xyz) == 0);
    DONE(toile_scene_faces(scene, 0, faces, 128, NULL));
    DONE(toile_scene_normals(scene, 0, xyz, 81, NULL));
    DONE(toile_scene_pinned(scene, 0, faces, 81, &count));
    HOLDS(count == 2 && faces[0] == 0 && faces[1] == 8);
    DONE(toile_scene_stats(scene, 0, &stats));
    DONE(toile_scene_picture(scene, TOILE_LOOK_FABRIC, 0, 16, 16, rgba, sizeof rgba));
}

static void snapshots(toile_scene scene)
{
    toile_snapshot snapshot, null = {0};
    toile_moment moment;
    const float *xyz;
    size_t count;
    DONE(toile_scene_snapshot(scene, &snapshot));
    USAGE(toile_snapshot_moment(snapshot, NULL), "null");
    USAGE(toile_snapshot_moment(null, &moment), "null handle");
    USAGE(toile_snapshot_garment(snapshot, 1, &xyz, &count), "no garment 1");
    USAGE(toile_snapshot_garment(snapshot, 0, NULL, &count), "null");
    USAGE(toile_snapshot_garment(snapshot, 0, &xyz, NULL), "null");
    DONE(toile_snapshot_moment(snapshot, &moment));
    HOLDS(moment.garments == 1 && moment.body_xyz == NULL);
    DONE(toile_snapshot_garment(snapshot, 0, &xyz, &count));
    DONE(toile_scene_step(scene));
    HOLDS(count == 81 && isfinite(xyz[3 * 80 + 1]));
    DONE(toile_snapshot_close(snapshot));
    USAGE(toile_snapshot_close(snapshot), "closed before");
    USAGE(toile_snapshot_moment(snapshot, &moment), "closed before");
    USAGE(toile_snapshot_garment(snapshot, 0, &xyz, &count), "closed before");
}

/* A measured person. Under valgrind that takes a quarter of an hour, and is left out. */
static void measuring(toile_recording recording)
{
    toile_recording null = {0};
    toile_measured measured, no_person = {0};
    toile_measured_facts known;
    toile_measure measure;
    toile_track track;
    toile_body body;
    const toile_joints *frames;
    size_t count;
    char text[1];
    DONE(toile_recording_measure(recording, NULL, &measured));
    USAGE(toile_recording_track(recording, no_person, &track), "null handle");
    USAGE(toile_recording_track(null, measured, &track), "null handle");
    USAGE(toile_recording_track(recording, measured, NULL), "null");
    DONE(toile_recording_track(recording, measured, &track));
    USAGE(toile_track_frames(track, NULL, &count), "null");
    USAGE(toile_track_frames(track, &frames, NULL), "null");
    DONE(toile_track_close(track));
    USAGE(toile_track_close(track), "closed before");
    USAGE(toile_track_frames(track, &frames, &count), "closed before");
    USAGE(toile_measured_read(measured, NULL), "null");
    DONE(toile_measured_read(measured, &known));
    USAGE(toile_measured_measure(measured, known.measures, &measure), "there is no measure");
    USAGE(toile_measured_measure(measured, 0, NULL), "null");
    USAGE(toile_measured_notes(measured, NULL, 0, NULL), "neither");
    USAGE(toile_measured_body(measured, NULL, 1, &body), "null");
    USAGE(toile_measured_body(measured, NULL, 0, NULL), "null");
    DONE(toile_measured_close(measured));
    USAGE(toile_measured_close(measured), "closed before");
    USAGE(toile_measured_read(measured, &known), "closed before");
    USAGE(toile_measured_measure(measured, 0, &measure), "closed before");
    USAGE(toile_measured_notes(measured, text, 1, NULL), "closed before");
    USAGE(toile_measured_body(measured, NULL, 0, &body), "closed before");
    USAGE(toile_recording_track(recording, measured, &track), "closed before");
}

static void recordings(toile_garment garment, int all)
{
    toile_recording recording, null = {0};
    toile_recording_facts facts;
    toile_measured measured;
    toile_try_on_result result;
    toile_given_measure tape[] = {{"chest", NAN}};
    toile_joints two[2];
    uint16_t depths[4] = {0};
    toile_depth_frame image = {0, 640, 480, 575, 575, 320, 240, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, depths, 4};
    memset(two, 0, sizeof two);
    INPUT(toile_recording_open("there-is-no-such.mcap", NULL, &recording), "there-is-no-such.mcap");
    USAGE(toile_recording_open(NULL, NULL, &recording), "null");
    USAGE(toile_recording_open("there-is-no-such.mcap", NULL, NULL), "null");
    INPUT(toile_recording_open("there-is-no-such.png", NO_UTF8, &recording), "camera");
    USAGE(toile_recording_embedded(NULL), "null");
    INPUT(toile_recording_from_frames("mine", NULL, 0, NULL, 0, &recording), "no frame");
    INPUT(toile_recording_from_frames("mine", two, 2, NULL, 0, &recording), "mine");
    USAGE(toile_recording_from_frames("mine", NULL, 2, NULL, 0, &recording), "null");
    USAGE(toile_recording_from_frames(NULL, two, 1, NULL, 0, &recording), "name is null");
    USAGE(toile_recording_from_frames("mine", two, 1, NULL, 0, NULL), "null");
    INPUT(toile_recording_from_frames("mine", NULL, 0, &image, 1, &recording), "4 depths");
    image.camera_to_world[11] = NAN;
    INPUT(toile_recording_from_frames("mine", NULL, 0, &image, 1, &recording), "finite");
    image.camera_to_world[11] = 0;
    image.depth_mm = NULL;
    USAGE(toile_recording_from_frames("mine", NULL, 0, &image, 1, &recording), "null");
    HOLDS(recording.id == 0);

    DONE(toile_recording_embedded(&recording));
    USAGE(toile_recording_read(recording, NULL), "null");
    USAGE(toile_recording_read(null, &facts), "null handle");
    USAGE(toile_recording_measure(null, NULL, &measured), "null handle");
    USAGE(toile_recording_measure(recording, NULL, NULL), "null");
    USAGE(toile_recording_measure(recording, &(toile_shopper){.sex = 5}, &measured), "5");
    USAGE(toile_recording_measure(recording, &(toile_shopper){.child = 7}, &measured), "child");
    USAGE(toile_recording_measure(recording, &(toile_shopper){.by_tape_count = 1}, &measured), "null");
    refused("toile_recording_measure", __LINE__,
            toile_recording_measure(recording, &(toile_shopper){.by_tape = tape, .by_tape_count = 1}, &measured), TOILE_CODE_INPUT,
            "chest");
    HOLDS(measured.id == 0);
    if (all)
        measuring(recording);

    USAGE(toile_try_on(null, &garment, 1, NULL, &result), "null handle");
    USAGE(toile_try_on(recording, NULL, 1, NULL, &result), "null");
    USAGE(toile_try_on(recording, &garment, 1, NULL, NULL), "null");
    USAGE(toile_try_on(recording, &garment, 1, &(toile_try_on_options){.width = 1}, &result), "1 x 0");
    USAGE(toile_try_on(recording, &garment, 1, &(toile_try_on_options){.quality = 8}, &result), "no quality");
    HOLDS(result.id == 0);
    DONE(toile_recording_close(recording));
    USAGE(toile_recording_close(recording), "closed before");
    USAGE(toile_recording_read(recording, &facts), "closed before");
    USAGE(toile_recording_measure(recording, NULL, &measured), "closed before");
    USAGE(toile_try_on(recording, &garment, 1, NULL, &result), "closed before");
}

/* What a try-on gave: one that was never made, and with `all` one that was. */
static void results(toile_garment garment, int all)
{
    toile_try_on_result result = {0};
    toile_try_on_facts facts;
    toile_measure measure;
    toile_recording recording;
    toile_scene scene;
    char text[1];
    uint8_t rgba[1];
    USAGE(toile_try_on_result_read(result, &facts), "null handle");
    USAGE(toile_try_on_result_measure(result, 0, &measure), "null handle");
    USAGE(toile_try_on_result_notes(result, text, 1, NULL), "null handle");
    USAGE(toile_try_on_result_picture(result, TOILE_LOOK_FABRIC, 0, rgba, 1, NULL), "null handle");
    USAGE(toile_try_on_result_scene(result, &scene), "null handle");
    DONE(toile_try_on_result_close(result));
    if (!all)
        return;
    DONE(toile_recording_embedded(&recording));
    DONE(toile_try_on(recording, &garment, 1, &(toile_try_on_options){.quality = TOILE_QUALITY_DRAFT}, &result));
    DONE(toile_recording_close(recording));
    USAGE(toile_try_on_result_read(result, NULL), "null");
    DONE(toile_try_on_result_read(result, &facts));
    USAGE(toile_try_on_result_measure(result, facts.measures, &measure), "there is no measure");
    USAGE(toile_try_on_result_measure(result, 0, NULL), "null");
    USAGE(toile_try_on_result_notes(result, NULL, 0, NULL), "neither");
    USAGE(toile_try_on_result_picture(result, TOILE_LOOK_FABRIC, 0, rgba, 1, NULL), "there is no picture 0");
    USAGE(toile_try_on_result_picture(result, 5, 0, rgba, 1, NULL), "no look");
    USAGE(toile_try_on_result_scene(result, NULL), "null");
    DONE(toile_try_on_result_scene(result, &scene));
    DONE(toile_try_on_result_close(result));
    USAGE(toile_try_on_result_scene(result, &scene), "closed before");
    USAGE(toile_try_on_result_close(result), "closed before");
    HOLDS(scene.id == 0);
}

static toile_scene shared;
static atomic_int busy_for_steps;

static void *steps(void *nothing)
{
    /* Where only one thread runs at a time, as under valgrind, the scene would be at work whenever the third looks. */
    const struct timespec pause = { 0, 1000000 };
    for (;; nanosleep(&pause, NULL)) {
        toile_code code = toile_scene_step_many(shared, 50);
        if (code == TOILE_CODE_USAGE && strstr(toile_last_error(), "another call is at work"))
            atomic_fetch_add(&busy_for_steps, 1);
        else if (code == TOILE_CODE_USAGE && strstr(toile_last_error(), "closed before"))
            break;
        else
            done("toile_scene_step_many", __LINE__, code);
    }
    return nothing;
}

/* Two threads step one scene while a third looks at it and then closes it: each call is done whole or refused. */
static void two_threads(void)
{
    pthread_t one, two;
    int busy = 0;
    toile_clock clock;
    toile_code code;
    shared = flag();
    HOLDS(pthread_create(&one, NULL, steps, NULL) == 0 && pthread_create(&two, NULL, steps, NULL) == 0);
    while (!busy || !atomic_load(&busy_for_steps)) {
        code = toile_scene_clock(shared, &clock);
        if (code == TOILE_CODE_USAGE && strstr(toile_last_error(), "another call is at work"))
            busy = 1;
        else
            HOLDS(code == TOILE_CODE_OK && clock.steps % 50 == 0);
        sched_yield();
    }
    while ((code = toile_scene_close(shared)) != TOILE_CODE_OK) {
        HOLDS(code == TOILE_CODE_USAGE && strstr(toile_last_error(), "another call is at work") != NULL);
        sched_yield();
    }
    pthread_join(one, NULL);
    pthread_join(two, NULL);
    every_call(shared, "closed before");
    USAGE(toile_scene_close(shared), "closed before");
}

/* The last error belongs to the thread. */
static void *own_error(void *nothing)
{
    HOLDS(strcmp(toile_last_error(), "") == 0);
    USAGE(toile_scene_step((toile_scene){0}), "null handle");
    return nothing;
}

int main(int argc, char **argv)
{
    toile_garment garment;
    toile_body body;
    pthread_t thread;
    int all = argc > 1 && strcmp(argv[1], "all") == 0;
    names();
    /* A coarse garment may be given, for what watches this program may make it slow. */
    DONE(toile_garment_open(argc > 2 ? argv[2] : "tee", NULL, NULL, &garment));
    DONE(toile_body_from_measures(TOILE_SEX_FEMALE, NULL, 0, &body));
    bodies(garment);
    garments();
    fits(body, garment);
    making_scenes(body, garment);
    toile_scene scene = flag();
    reading_scenes(scene);
    snapshots(scene);
    DONE(toile_scene_close(scene));
    every_call(scene, "closed before");
    recordings(garment, all);
    results(garment, all);
    two_threads();
    HOLDS(pthread_create(&thread, NULL, own_error, NULL) == 0 && pthread_join(thread, NULL) == 0);
    DONE(toile_body_close(body));
    DONE(toile_garment_close(garment));
    if (faults)
        fprintf(stderr, "bad_input: %d faults\n", faults);
    else
        puts("bad_input: every call refuses what is wrong");
    return faults != 0;
}
