/*
 * Toile: a virtual fitting room. Bodies of measures, garments of files, cloth that moves, size and fit, pictures.
 * Guide: docs/c.md. Licence: MIT or Apache-2.0.
 *
 * Units: metres and seconds; what is taken by tape, and ease, in millimetres (_mm). Right-handed, y up, the floor at y = 0, a body
 * faces +z, its left is +x. A step is 1/120 s, or what a scene file says.
 *
 * Errors: a call that can fail gives a toile_code; 0 is success. toile_last_error() then says what is wrong and what cures it, in one
 * sentence. A call that fails changes nothing but a handle that it was to fill, which becomes null. What it takes is checked: null
 * pointers, numbers that are not finite, counts, text that is not UTF-8, handles that were closed. No panic and no exception
 * leaves the library, and it writes no log.
 *
 * Handles are numbers in a struct, to be copied at will. { 0 } is the null handle. A handle that was closed is refused for ever, also
 * by calls that come later on other threads. Each is closed once by its toile_..._close; to close a null handle does nothing.
 *
 * Threads: any thread may call. Scenes take one call at a time: a second one that comes meanwhile, on any other thread, is refused
 * with TOILE_CODE_USAGE and does nothing. All other handles never change and may be read by many threads at once.
 * Programs that fork make scenes after it.
 *
 * Memory: const pointers that a call hands out belong to the handle that was asked, and live until it is closed, where nothing
 * else is said. Nothing is to be freed but by closing handles. A call that fills an array takes the array, for how many elements
 * it has room, and where to put how many there are; a null array with room for 0 asks for the number alone.
 */

#ifndef TOILE_H
#define TOILE_H

/* Generated of engine/c/src by cbindgen; TOILE_RENEW_API=1 cargo test -p toile-c --test main header writes it anew. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * Joints of a person, and the places of toile_joints.
 */
#define TOILE_JOINTS 23

/**
 * The number of this header's ABI, which the name of the shared library carries. It rises with whatever breaks a program that was
 * built before: compare it with toile_abi_version() where the library is loaded at run time.
 */
#define TOILE_ABI_VERSION 1

/**
 * How a call ended. The numbers are those with which the program `toile` exits.
 */
typedef enum {
    /**
     * It is done.
     */
    TOILE_CODE_OK = 0,
    /**
     * The call itself is wrong: a null pointer, a handle that was closed, an index out of range, a busy scene.
     */
    TOILE_CODE_USAGE = 2,
    /**
     * What was given cannot be used: a file, a name, a measure, a mesh, a number that is not finite.
     */
    TOILE_CODE_INPUT = 4,
    /**
     * The system does not give what is needed: a thread, a file that can be written.
     */
    TOILE_CODE_DEVICE = 5,
    /**
     * A fault of Toile's own. The scene that was called, if any, can only be closed.
     */
    TOILE_CODE_INTERNAL = 70,
} toile_code;

/**
 * Whose body, or whose proportions.
 */
typedef enum {
    /**
     * Not known; only of a shopper.
     */
    TOILE_SEX_UNKNOWN = 0,
    /**
     * A woman's.
     */
    TOILE_SEX_FEMALE = 1,
    /**
     * A man's.
     */
    TOILE_SEX_MALE = 2,
} toile_sex;

/**
 * Tested settings of the cloth.
 */
typedef enum {
    /**
     * TOILE_QUALITY_SHOP.
     */
    TOILE_QUALITY_DEFAULT = 0,
    /**
     * For many bodies or slow machines.
     */
    TOILE_QUALITY_DRAFT = 1,
    /**
     * For a mirror in a shop.
     */
    TOILE_QUALITY_SHOP = 2,
    /**
     * For pictures.
     */
    TOILE_QUALITY_FINE = 3,
} toile_quality;

/**
 * How a body moves.
 */
typedef enum {
    /**
     * It stands, arms beside the hips.
     */
    TOILE_MOTION_STANDING = 0,
    /**
     * It sits, hips and knees at right angles.
     */
    TOILE_MOTION_SITTING = 1,
    /**
     * It stands as the one frame of joints is; toile_scene_step_to moves it on.
     */
    TOILE_MOTION_JOINTS = 2,
    /**
     * It follows the frames of joints at their own times, such as toile_track_frames lends.
     */
    TOILE_MOTION_TRACK = 3,
} toile_motion;

/**
 * What a picture shows of cloth.
 */
typedef enum {
    /**
     * The fabrics.
     */
    TOILE_LOOK_FABRIC = 0,
    /**
     * The fit map.
     */
    TOILE_LOOK_FIT_MAP = 1,
} toile_look;

/**
 * A joint: its place in toile_joints.
 */
typedef enum {
    /**
     * Where the trunk hangs: the middle of the sacroiliac joints.
     */
    TOILE_JOINT_PELVIS,
    /**
     * Of the lowest lumbar vertebra: trunk on pelvis.
     */
    TOILE_JOINT_SPINE,
    /**
     * Of the highest lumbar vertebra: rib cage on loins.
     */
    TOILE_JOINT_CHEST,
    /**
     * Of the middle of the neck.
     */
    TOILE_JOINT_NECK,
    /**
     * Of skull on neck.
     */
    TOILE_JOINT_HEAD,
    /**
     * Of the left collar bone on the breastbone.
     */
    TOILE_JOINT_LEFT_CLAVICLE,
    /**
     * Of the left upper arm.
     */
    TOILE_JOINT_LEFT_SHOULDER,
    /**
     * Of the left forearm.
     */
    TOILE_JOINT_LEFT_ELBOW,
    /**
     * Of the left hand.
     */
    TOILE_JOINT_LEFT_WRIST,
    /**
     * The knuckle of the left middle finger.
     */
    TOILE_JOINT_LEFT_HAND,
    /**
     * Of the left thigh.
     */
    TOILE_JOINT_LEFT_HIP,
    /**
     * Of the left shin.
     */
    TOILE_JOINT_LEFT_KNEE,
    /**
     * Of the left foot.
     */
    TOILE_JOINT_LEFT_ANKLE,
    /**
     * The ball of the left foot.
     */
    TOILE_JOINT_LEFT_TOE,
    /**
     * Of the right collar bone on the breastbone.
     */
    TOILE_JOINT_RIGHT_CLAVICLE,
    /**
     * Of the right upper arm.
     */
    TOILE_JOINT_RIGHT_SHOULDER,
    /**
     * Of the right forearm.
     */
    TOILE_JOINT_RIGHT_ELBOW,
    /**
     * Of the right hand.
     */
    TOILE_JOINT_RIGHT_WRIST,
    /**
     * The knuckle of the right middle finger.
     */
    TOILE_JOINT_RIGHT_HAND,
    /**
     * Of the right thigh.
     */
    TOILE_JOINT_RIGHT_HIP,
    /**
     * Of the right shin.
     */
    TOILE_JOINT_RIGHT_KNEE,
    /**
     * Of the right foot.
     */
    TOILE_JOINT_RIGHT_ANKLE,
    /**
     * The ball of the right foot.
     */
    TOILE_JOINT_RIGHT_TOE,
} toile_joint;

/**
 * A list of names.
 */
typedef enum {
    /**
     * Garments that are built in.
     */
    TOILE_NAME_LIST_GARMENTS = 0,
    /**
     * Fabrics that are built in.
     */
    TOILE_NAME_LIST_FABRICS = 1,
    /**
     * Measures of a body.
     */
    TOILE_NAME_LIST_MEASURES = 2,
} toile_name_list;

/**
 * A measure that is given.
 */
typedef struct {
    /**
     * A name of TOILE_NAME_LIST_MEASURES, or a word for one: "chest", "height", "inseam".
     */
    const char *name;
    /**
     * The value (mm).
     */
    double mm;
} toile_given_measure;

/**
 * A body in its rest pose, feet on the floor, facing +z.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_body;

/**
 * The mesh of a body, lent.
 */
typedef struct {
    /**
     * Rest positions, x, y, z of each vertex (m).
     */
    const float *xyz;
    /**
     * Vertices.
     */
    size_t vertices;
    /**
     * Triangles, three vertices each, counter-clockwise from outside.
     */
    const uint32_t *faces;
    /**
     * Triangles.
     */
    size_t face_count;
} toile_body_mesh;

/**
 * A garment, open and checked. It can be put on many bodies.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_garment;

/**
 * A size, judged on a body.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_fit;

/**
 * What a judgement says. Texts are lent by its handle.
 */
typedef struct {
    /**
     * Name of the garment.
     */
    const char *garment;
    /**
     * Code of the size.
     */
    const char *size;
    /**
     * Probability that this size suits this person best.
     */
    float probability;
    /**
     * Whether no size is sure.
     */
    bool uncertain;
    /**
     * The recommendation in sentences.
     */
    const char *verdict;
    /**
     * The next best size, where it may be the better one; otherwise null.
     */
    const char *runner_up;
    /**
     * Set where no size is made for this person, or guesses stand for measures; otherwise null.
     */
    const char *note;
    /**
     * The girth to take by tape, where no size is sure and it would help: "chest", "waist" or "hip"; otherwise null.
     */
    const char *advice_zone;
    /**
     * The same in a sentence; otherwise null.
     */
    const char *advice;
    /**
     * Zones that toile_fit_zone gives.
     */
    size_t zones;
    /**
     * Sizes that toile_fit_size gives.
     */
    size_t sizes;
} toile_fit_summary;

/**
 * How a size fits in one zone. Texts are lent by the fit.
 */
typedef struct {
    /**
     * Its name: "chest".
     */
    const char *zone;
    /**
     * Whether the size is chosen by this zone.
     */
    bool primary;
    /**
     * Girth of the garment less that of the body (mm).
     */
    double ease_mm;
    /**
     * Standard deviation of the ease (mm): that of the body's measure.
     */
    double sigma_mm;
    /**
     * "tight", "good", "loose", or "unknown" where the body was not seen there.
     */
    const char *verdict;
    /**
     * How it feels, from "too tight" over "right" to "too loose"; null where the body was not seen there.
     */
    const char *feel;
    /**
     * -1 (loose) .. 1 (tight); NaN where the body was not seen there.
     */
    float tightness;
    /**
     * The same for a person to read.
     */
    const char *sentence;
} toile_zone;

/**
 * A size with the probability that it suits this person best. The text is lent by the fit.
 */
typedef struct {
    /**
     * Code of the size.
     */
    const char *size;
    /**
     * The probability; those of all sizes sum to 1.
     */
    float probability;
} toile_size_chance;

/**
 * One joint as tracked.
 */
typedef struct {
    /**
     * World position (m); meaningless where the confidence is 0.
     */
    float x;
    /**
     * Up.
     */
    float y;
    /**
     * Ahead of the person.
     */
    float z;
    /**
     * How far to believe it, 0 (absent) to 1 (seen); believed from 0.5.
     */
    float confidence;
} toile_tracked_joint;

/**
 * All joints at one moment.
 */
typedef struct {
    /**
     * Time since the session began (ns).
     */
    uint64_t time_ns;
    /**
     * The joints, each at the place of its toile_joint.
     */
    toile_tracked_joint joints[TOILE_JOINTS];
} toile_joints;

/**
 * Air that moves.
 */
typedef struct {
    /**
     * Velocity along x, y, z (m/s), each at most 1000.
     */
    float velocity[3];
    /**
     * Drag (1), 0 to 100.
     */
    float drag;
    /**
     * Lift (1), 0 to 100.
     */
    float lift;
} toile_wind;

/**
 * How a body is dressed. Zeros throughout, { 0 }, are the defaults: it stands, quality shop, still air, nothing tucked in.
 */
typedef struct {
    /**
     * A toile_motion.
     */
    int32_t motion;
    /**
     * A toile_quality.
     */
    int32_t quality;
    /**
     * Threads that share a step, 1 or 2, which give the same bits; 0 is the default.
     */
    uint32_t workers;
    /**
     * Frames of joints, of TOILE_MOTION_JOINTS one; null of other motions but TOILE_MOTION_TRACK.
     */
    const toile_joints *joints;
    /**
     * How many.
     */
    size_t joint_frames;
    /**
     * Air that moves; null is still air.
     */
    const toile_wind *wind;
    /**
     * Names of garments that are tucked into the next one under them that has a waistband; null is none.
     */
    const char *const *tuck;
    /**
     * How many.
     */
    size_t tuck_count;
} toile_dress_options;

/**
 * A scene in motion: a dressed body, or cloth and colliders of a scene file. It takes one call at a time.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_scene;

/**
 * A file that a scene file names, in memory.
 */
typedef struct {
    /**
     * The name that the scene file has for it.
     */
    const char *name;
    /**
     * What is in it.
     */
    const uint8_t *bytes;
    /**
     * How many bytes.
     */
    size_t size;
} toile_file;

/**
 * A garment of a scene. Texts are lent by the scene.
 */
typedef struct {
    /**
     * What it was opened by, or the name that the scene file gives it.
     */
    const char *name;
    /**
     * Code of its size; empty in a scene file.
     */
    const char *size;
    /**
     * Its fabric.
     */
    const char *fabric;
    /**
     * Vertices in the caller's order.
     */
    size_t vertices;
    /**
     * Triangles.
     */
    size_t faces;
    /**
     * Layers of a mesh that lie over each other; 1 of all else.
     */
    size_t layers;
    /**
     * Whether toile_scene_fit has a fit of it: not of a mesh without sizes, nor in a scene file.
     */
    bool has_fit;
} toile_worn_garment;

/**
 * How a garment does at the moment.
 */
typedef struct {
    /**
     * Mean strain of warp and weft edges, |length / rest - 1| (1).
     */
    float strain_mean;
    /**
     * 99th percentile of it (1).
     */
    float strain_p99;
    /**
     * The worst edge's (1).
     */
    float strain_max;
    /**
     * Deepest point of a free particle inside of the body or the colliders (mm).
     */
    float penetration_mm;
    /**
     * Steps so far that were not finite and were rolled back.
     */
    uint64_t rolled_back;
} toile_garment_stats;

/**
 * Everything that a display needs of one moment. It never changes: another thread may draw it while the scene is stepped.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_snapshot;

/**
 * When a snapshot was taken, and what is in it.
 */
typedef struct {
    /**
     * Steps that were taken.
     */
    uint64_t step;
    /**
     * Time that was reached (s).
     */
    double time_s;
    /**
     * Garments.
     */
    size_t garments;
    /**
     * Vertices of the body; 0 of a scene file.
     */
    size_t body_vertices;
    /**
     * Positions of the body, x, y, z of each vertex (m), lent by the snapshot; null of a scene file.
     */
    const float *body_xyz;
    /**
     * Unit normals of the body, lent by the snapshot; null of a scene file.
     */
    const float *body_normals;
} toile_moment;

/**
 * Where a scene stands in time.
 */
typedef struct {
    /**
     * Steps taken so far.
     */
    uint64_t steps;
    /**
     * Time reached (s).
     */
    double time_s;
    /**
     * Length of a step (s).
     */
    double time_step_s;
    /**
     * Steps from beginning to end: of the track that is followed, or of the scene file's duration; 0 of a body that stands.
     */
    uint64_t duration_steps;
} toile_clock;

/**
 * What a sensor saw of one person: frames of joints, depth images, or both.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_recording;

/**
 * A depth image of the caller's own sensor.
 */
typedef struct {
    /**
     * Time since the session began (ns).
     */
    uint64_t time_ns;
    /**
     * Width (px).
     */
    uint32_t width;
    /**
     * Height (px).
     */
    uint32_t height;
    /**
     * Focal length along x (px).
     */
    float fx;
    /**
     * Focal length along y (px).
     */
    float fy;
    /**
     * Principal point x (px).
     */
    float cx;
    /**
     * Principal point y (px).
     */
    float cy;
    /**
     * Camera (x right, y down, z forward) to world (m): three columns of the rotation, then the place.
     */
    float camera_to_world[12];
    /**
     * Depth of each pixel (mm), row by row from the top; 0 where nothing was seen.
     */
    const uint16_t *depth_mm;
    /**
     * Pixels that `depth_mm` has: width times height.
     */
    size_t pixels;
} toile_depth_frame;

/**
 * What a recording has.
 */
typedef struct {
    /**
     * Time of the last frame (s); the first is at 0.
     */
    double seconds;
    /**
     * Frames of joints.
     */
    size_t joint_frames;
    /**
     * Depth images.
     */
    size_t depth_frames;
} toile_recording_facts;

/**
 * What is known of a person before they are measured. Zeros throughout, { 0 }, are: nothing.
 */
typedef struct {
    /**
     * A toile_sex.
     */
    int32_t sex;
    /**
     * Whether it is a child: 1 is yes, -1 is no, 0 is not known.
     */
    int32_t child;
    /**
     * Whether they wear nothing that stands off the skin; otherwise everyday clothes, which the body lies beneath.
     */
    uint8_t tight_clothes;
    /**
     * Whether they sit: nothing is taken from legs and hips, which a chair hides.
     */
    uint8_t seated;
    /**
     * Measures that were taken by tape; all others follow them. Null is none.
     */
    const toile_given_measure *by_tape;
    /**
     * How many.
     */
    size_t by_tape_count;
} toile_shopper;

/**
 * A measured person.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_measured;

/**
 * Filtered frames of joints that a scene can follow.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_track;

/**
 * What is known of a measured person.
 */
typedef struct {
    /**
     * Measures that toile_measured_measure gives.
     */
    size_t measures;
    /**
     * Odds that it is a child, 0 to 1; NaN without a stature. Bodies and sizes here are adults'.
     */
    float child;
} toile_measured_facts;

/**
 * A measure of a measured person. Texts are lent by the handle that was asked.
 */
typedef struct {
    /**
     * Its name, such as "waist_girth".
     */
    const char *name;
    /**
     * The value (mm).
     */
    double mm;
    /**
     * Standard deviation of the value (mm).
     */
    double sigma_mm;
    /**
     * Whether it was seen; where it was not, it is what a body with the others has on average.
     */
    bool seen;
    /**
     * Where it is taken.
     */
    const char *definition;
} toile_measure;

/**
 * How a try-on is made. Zeros throughout, { 0 }, are the defaults: nothing is known, quality shop, no pictures, nothing tucked in.
 */
typedef struct {
    /**
     * What is known of the person; null is nothing.
     */
    const toile_shopper *shopper;
    /**
     * A toile_quality.
     */
    int32_t quality;
    /**
     * Width of each picture (px); 0 makes none.
     */
    uint32_t width;
    /**
     * Height of each picture (px).
     */
    uint32_t height;
    /**
     * Names of garments that are tucked in; null is none.
     */
    const char *const *tuck;
    /**
     * How many.
     */
    size_t tuck_count;
} toile_try_on_options;

/**
 * A try-on that was made.
 */
typedef struct {
    /**
     * Its number; 0 is the null handle.
     */
    uint64_t id;
} toile_try_on_result;

/**
 * What a try-on gives.
 */
typedef struct {
    /**
     * Measures of the person.
     */
    size_t measures;
    /**
     * Pictures of each look: front, side, back; 0 where none were asked for.
     */
    size_t pictures;
    /**
     * Their width (px).
     */
    uint32_t width;
    /**
     * Their height (px).
     */
    uint32_t height;
} toile_try_on_facts;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * What the last call of this thread that failed had to say: one sentence with the cure, UTF-8, after the name of the call. Empty
 * before any failed. A call that succeeds leaves it as it is. It lives until the next call of this thread fails.
 */
const char *toile_last_error(void);

/**
 * The body of a sex (a toile_sex) that has these measures, each within 2 mm; all others are what people with these are expected to
 * have. Without any, the average body.
 */
toile_code toile_body_from_measures(int32_t sex,
                                    const toile_given_measure *given,
                                    size_t count,
                                    toile_body *body);

/**
 * A body that others made: a skinned glTF 2.0 mesh (.glb, .gltf) or a VRM avatar. Its measures are read off it, and believed to
 * 10 mm. The sex (a toile_sex) says whose garments it wears.
 */
toile_code toile_body_open(const char *path, int32_t sex, toile_body *body);

/**
 * A measure of a body by its name or a word for it (mm).
 */
toile_code toile_body_measure_mm(toile_body body, const char *name, double *mm);

/**
 * How many measures are read off a body.
 */
toile_code toile_body_measure_count(toile_body body, size_t *count);

/**
 * One of them by its number from 0: its name, lent by the body, and its value (mm).
 */
toile_code toile_body_measure(toile_body body, size_t index, const char **name, double *mm);

/**
 * The mesh of a body in its rest pose, lent by the body.
 */
toile_code toile_body_mesh_of(toile_body body, toile_body_mesh *mesh);

/**
 * Notes on how a body was made, a line each, as a text into `bytes`; its length with the closing zero into
 * `needed`.
 */
toile_code toile_body_notes(toile_body body, char *bytes, size_t room, size_t *needed);

/**
 * Closes a body. Scenes and garments that were made with it keep what they need.
 */
toile_code toile_body_close(toile_body body);

/**
 * Opens a garment: a name of TOILE_NAME_LIST_GARMENTS, the path of a mesh (OBJ, glTF, GLB), of a sewn pattern (GarmentCode or
 * FreeSewing JSON, DXF) or of a garment package; behind a colon a built-in fabric may stand, "shirt:lawn-gingham". `size` and
 * `fabric` may be null: the size that fits, the garment's own fabric. A fabric is a name of TOILE_NAME_LIST_FABRICS, or the path of
 * a TOML file.
 */
toile_code toile_garment_open(const char *name,
                              const char *size,
                              const char *fabric,
                              toile_garment *garment);

/**
 * The sizes that are made, smallest first, a line each, as a text into `bytes`; its length with the closing zero into `needed`. Empty
 * of a mesh that has no sizes.
 */
toile_code toile_garment_sizes(toile_garment garment,
                               char *bytes,
                               size_t room,
                               size_t *needed);

/**
 * The name of the fabric that a garment is made of, as a text into `bytes`; its length with the closing zero into `needed`.
 */
toile_code toile_garment_fabric(toile_garment garment, char *bytes, size_t room, size_t *needed);

/**
 * Closes a garment. Scenes that wear it keep what they need.
 */
toile_code toile_garment_close(toile_garment garment);

/**
 * The version of the library, such as "0.3.0"; it lives for ever.
 */
const char *toile_version(void);

/**
 * The TOILE_ABI_VERSION that the library was built with.
 */
uint32_t toile_abi_version(void);

/**
 * A name of a list (a toile_name_list) by its number from 0; null behind the last one, and of an unknown list, which
 * toile_last_error() then says. It lives for ever.
 */
const char *toile_name(int32_t list, size_t index);

/**
 * The colour of a value of a fit map, -1 (loose) .. 1 (tight): sRGB into rgb[3], one of eight steps that colour-blind readers tell
 * apart. Mid grey for NaN.
 */
toile_code toile_fit_colour(float tightness,
                            uint8_t *rgb);

/**
 * The size of a garment that fits a body, or how the one that was asked for does, worn over nothing else.
 */
toile_code toile_recommend(toile_body body, toile_garment garment, toile_fit *fit);

/**
 * What a fit says.
 */
toile_code toile_fit_read(toile_fit fit, toile_fit_summary *summary);

/**
 * A zone of a fit by its number from 0, the primary ones first.
 */
toile_code toile_fit_zone(toile_fit fit, size_t index, toile_zone *zone);

/**
 * A size of a fit by its number from 0, smallest first.
 */
toile_code toile_fit_size(toile_fit fit, size_t index, toile_size_chance *size);

/**
 * Closes a fit.
 */
toile_code toile_fit_close(toile_fit fit);

/**
 * Puts garments on a body, inner first, each in the size that was asked for or the one that fits, and lets them settle. `options` may
 * be null.
 */
toile_code toile_scene_dress(toile_body body,
                             const toile_garment *worn,
                             size_t count,
                             const toile_dress_options *options,
                             toile_scene *scene);

/**
 * Reads a scene file, with the files beside it that it names, and honours all that it says (docs/scene.md).
 */
toile_code toile_scene_open(const char *path, toile_scene *scene);

/**
 * The same of a text; the files that it names are given along, by the names that it has for them, and no other is read. `name` is
 * what messages call the text.
 */
toile_code toile_scene_parse(const char *name,
                             const char *text,
                             const toile_file *files,
                             size_t count,
                             toile_scene *scene);

/**
 * A piece of cloth of the caller's own triangles in a built-in fabric, held at the vertices `pins`, which stay at exactly these
 * positions. xyz[3 * vertices] (m), triangles[3 * triangle_count] by vertices counted from 0, pins[pin_count].
 */
toile_code toile_scene_of_mesh(const float *xyz,
                               size_t vertices,
                               const uint32_t *triangles,
                               size_t triangle_count,
                               const uint32_t *pins,
                               size_t pin_count,
                               const char *fabric,
                               toile_scene *scene);

/**
 * Closes a scene and ends its threads. A scene that another thread's call is at work on is refused and stays open.
 */
toile_code toile_scene_close(toile_scene scene);

/**
 * A picture of this moment by the ray tracer: rgba[4 * width * height] in sRGB, rows from the top, alpha 255; `room` is the
 * array's bytes. It is taken from the front, turned towards the body's left by so many degrees: 90 is its left side, 180 its back.
 * Sides have 16 to 4320 pixels. It takes every core.
 */
toile_code toile_scene_picture(toile_scene scene,
                               int32_t shows,
                               float degrees,
                               uint32_t width,
                               uint32_t height,
                               uint8_t *rgba,
                               size_t room);

/**
 * The same as a PNG file, over whatever was there.
 */
toile_code toile_scene_write_png(toile_scene scene, int32_t shows, float degrees, uint32_t width, uint32_t height, const char *path);

/**
 * How many garments a scene has. They are numbered from 0, inner first.
 */
toile_code toile_scene_garment_count(toile_scene scene, size_t *count);

/**
 * A garment of a scene.
 */
toile_code toile_scene_garment(toile_scene scene, size_t garment, toile_worn_garment *worn);

/**
 * How a garment's size fits over what is worn beneath, as it was dressed.
 */
toile_code toile_scene_fit(toile_scene scene, size_t garment, toile_fit *fit);

/**
 * Where the vertices of a garment are (m), in the order of the caller's own mesh; of a garment that was drafted, in the order of its
 * draft. xyz[3 * room]; `count`, which may be null, tells how many vertices there are. Always finite. Nothing is allocated.
 */
toile_code toile_scene_positions(toile_scene scene,
                                 size_t garment,
                                 float *xyz,
                                 size_t room,
                                 size_t *count);

/**
 * The same, lent by the scene until the scene's next step, until the same garment's positions are lent again, or until the scene is
 * closed. Later calls lend the same memory; only the first one allocates.
 */
toile_code toile_scene_lend_positions(toile_scene scene,
                                      size_t garment,
                                      const float **xyz,
                                      size_t *count);

/**
 * Unit normals of a garment's vertices, xyz[3 * room]; zero where a vertex has no face.
 */
toile_code toile_scene_normals(toile_scene scene, size_t garment, float *xyz, size_t room, size_t *count);

/**
 * Triangles of a garment by the vertices of toile_scene_positions, faces[3 * room]; quads are split. They never change.
 */
toile_code toile_scene_faces(toile_scene scene, size_t garment, uint32_t *faces, size_t room, size_t *count);

/**
 * The vertices of a garment that are held: by pins, by the body where it is worn close, or without a face.
 */
toile_code toile_scene_pinned(toile_scene scene, size_t garment, uint32_t *pinned, size_t room, size_t *count);

/**
 * How tight a garment sits at each vertex, -1 (loose) .. 1 (tight); toile_fit_colour gives the colours. NaN where a vertex has no
 * face. Not of a scene file.
 */
toile_code toile_scene_fit_map(toile_scene scene,
                               size_t garment,
                               float *tightness,
                               size_t room,
                               size_t *count);

/**
 * How a garment does at the moment: stretch, penetration. Not for every frame of a display.
 */
toile_code toile_scene_stats(toile_scene scene, size_t garment, toile_garment_stats *stats);

/**
 * Vertices of the body as it stands now, xyz[3 * room] (m), and their unit normals, normals[3 * room], which may be null. Not of a
 * scene file.
 */
toile_code toile_scene_body(toile_scene scene,
                            float *xyz,
                            float *normals,
                            size_t room,
                            size_t *count);

/**
 * Triangles of the body, faces[3 * room]. They never change. Not of a scene file.
 */
toile_code toile_scene_body_faces(toile_scene scene, uint32_t *faces, size_t room, size_t *count);

/**
 * A hash of the whole state: the same input gives the same one on every run of a build, with one worker or two.
 */
toile_code toile_scene_state_hash(toile_scene scene, uint64_t *hash);

/**
 * What the steps so far had to repair or leave out, a line each, as a text into `bytes`; its length with the closing zero into
 * `needed`.
 */
toile_code toile_scene_warnings(toile_scene scene, char *bytes, size_t room, size_t *needed);

/**
 * What was repaired in a garment's mesh and what became of its pieces, a line each, as a text into `bytes`; its length with the
 * closing zero into `needed`.
 */
toile_code toile_scene_notes(toile_scene scene, size_t garment, char *bytes, size_t room, size_t *needed);

/**
 * Keeps this moment of a scene.
 */
toile_code toile_scene_snapshot(toile_scene scene, toile_snapshot *snapshot);

/**
 * When a snapshot was taken, and the body in it.
 */
toile_code toile_snapshot_moment(toile_snapshot snapshot, toile_moment *moment);

/**
 * Positions of a garment in a snapshot, x, y, z of each vertex (m), lent by the snapshot, and the number of its vertices.
 */
toile_code toile_snapshot_garment(toile_snapshot snapshot, size_t garment, const float **xyz, size_t *count);

/**
 * Closes a snapshot.
 */
toile_code toile_snapshot_close(toile_snapshot snapshot);

/**
 * One step. A body that follows a track goes on as in its last frame once that has ended.
 */
toile_code toile_scene_step(toile_scene scene);

/**
 * So many steps, at most 1,000,000,000.
 */
toile_code toile_scene_step_many(toile_scene scene, uint64_t steps);

/**
 * One step of a dressed body to joints of the caller's own, those at the step's end; it stays there until moved on. Not of a body
 * that follows a track.
 */
toile_code toile_scene_step_to(toile_scene scene,
                               const toile_joints *joints);

/**
 * Where a scene stands in time.
 */
toile_code toile_scene_clock(toile_scene scene, toile_clock *clock);

/**
 * Opens a recording: MCAP, Kinect CSV, Kinectron JSON, BVH, Azure Kinect, OpenNI, OpenPose, depth images and others (docs/depth.md).
 * `camera` is null, or a JSON file that describes the camera of depth images which have none of their own.
 */
toile_code toile_recording_open(const char *path,
                                const char *camera,
                                toile_recording *recording);

/**
 * The recording that comes with Toile.
 */
toile_code toile_recording_embedded(toile_recording *recording);

/**
 * Frames that a sensor of the caller's own saw, in metres, y up, the floor at y = 0, the person facing +z; times rise from frame to
 * frame. One of the two may be none.
 */
toile_code toile_recording_from_frames(const char *name,
                                       const toile_joints *joints,
                                       size_t joint_frames,
                                       const toile_depth_frame *depth,
                                       size_t depth_frames,
                                       toile_recording *recording);

/**
 * What a recording has.
 */
toile_code toile_recording_read(toile_recording recording, toile_recording_facts *facts);

/**
 * Measures the person in a recording: by a body fitted to depth where there is any, by the joints otherwise. `shopper` may be
 * null: nothing is known before.
 */
toile_code toile_recording_measure(toile_recording recording, const toile_shopper *shopper, toile_measured *measured);

/**
 * The filtered joints from the moment on at which the person can be dressed; of depth alone, the body is followed through it.
 */
toile_code toile_recording_track(toile_recording recording, toile_measured measured, toile_track *track);

/**
 * The frames of a track, lent by it: what toile_dress_options takes.
 */
toile_code toile_track_frames(toile_track track, const toile_joints **frames, size_t *count);

/**
 * What is known of a measured person.
 */
toile_code toile_measured_read(toile_measured measured, toile_measured_facts *facts);

/**
 * A measure of a person by its number from 0.
 */
toile_code toile_measured_measure(toile_measured measured, size_t index, toile_measure *measure);

/**
 * Notes on the measures, a line each, as a text into `bytes`; its length with the closing zero into `needed`.
 */
toile_code toile_measured_notes(toile_measured measured, char *bytes, size_t room, size_t *needed);

/**
 * The body of a person's measures. Where the sex is neither known nor seen it is that of whom the garments are made for, of none a
 * woman's.
 */
toile_code toile_measured_body(toile_measured measured,
                               const toile_garment *worn,
                               size_t count,
                               toile_body *body);

/**
 * Closes a recording.
 */
toile_code toile_recording_close(toile_recording recording);

/**
 * Closes what is known of a person.
 */
toile_code toile_measured_close(toile_measured measured);

/**
 * Closes a track. Scenes that follow it keep what they need.
 */
toile_code toile_track_close(toile_track track);

/**
 * Measures the person in a recording, puts the garments on a body of those measures, inner first, lets them move as the recording
 * does and draws its end: the same measures, sizes and bits as `toile try-on`. `options` may be null.
 */
toile_code toile_try_on(toile_recording recording,
                        const toile_garment *worn,
                        size_t count,
                        const toile_try_on_options *options,
                        toile_try_on_result *result);

/**
 * What a try-on gives.
 */
toile_code toile_try_on_result_read(toile_try_on_result result, toile_try_on_facts *facts);

/**
 * A measure of the person by its number from 0.
 */
toile_code toile_try_on_result_measure(toile_try_on_result result, size_t index, toile_measure *measure);

/**
 * Notes on the measures and the body, a line each, as a text into `bytes`; its length with the closing zero into
 * `needed`.
 */
toile_code toile_try_on_result_notes(toile_try_on_result result, char *bytes, size_t room, size_t *needed);

/**
 * A picture of the recording's end in a look (a toile_look): 0 is the front, 1 the side, 2 the back. rgba as toile_scene_picture
 * gives it; `needed` tells how many bytes there are.
 */
toile_code toile_try_on_result_picture(toile_try_on_result result,
                                       int32_t shows,
                                       size_t view,
                                       uint8_t *rgba,
                                       size_t room,
                                       size_t *needed);

/**
 * The scene as the recording ended, with the fit of each garment; the caller closes it. It can be taken out once.
 */
toile_code toile_try_on_result_scene(toile_try_on_result result, toile_scene *scene);

/**
 * Closes a try-on, with its scene where that was not taken out.
 */
toile_code toile_try_on_result_close(toile_try_on_result result);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TOILE_H */
