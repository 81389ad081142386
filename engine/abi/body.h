/* toile/abi/body.h - a person's shape (immutable) and, apart from it, what moves each frame. */
#ifndef TOILE_ABI_BODY_H
#define TOILE_ABI_BODY_H
#include "base.h"
#ifdef __cplusplus
extern "C" {
#endif

/* The 22 joints, VRM 1.0 humanoid names, parents before children. */
enum {
    TOILE_JOINT_HIPS = 0,
    TOILE_JOINT_SPINE,
    TOILE_JOINT_CHEST,
    TOILE_JOINT_UPPER_CHEST,
    TOILE_JOINT_NECK,
    TOILE_JOINT_HEAD,
    TOILE_JOINT_LEFT_SHOULDER,
    TOILE_JOINT_LEFT_UPPER_ARM,
    TOILE_JOINT_LEFT_LOWER_ARM,
    TOILE_JOINT_LEFT_HAND,
    TOILE_JOINT_RIGHT_SHOULDER,
    TOILE_JOINT_RIGHT_UPPER_ARM,
    TOILE_JOINT_RIGHT_LOWER_ARM,
    TOILE_JOINT_RIGHT_HAND,
    TOILE_JOINT_LEFT_UPPER_LEG,
    TOILE_JOINT_LEFT_LOWER_LEG,
    TOILE_JOINT_LEFT_FOOT,
    TOILE_JOINT_LEFT_TOES,
    TOILE_JOINT_RIGHT_UPPER_LEG,
    TOILE_JOINT_RIGHT_LOWER_LEG,
    TOILE_JOINT_RIGHT_FOOT,
    TOILE_JOINT_RIGHT_TOES,
    TOILE_JOINT_COUNT
};

/* Per-vertex part labels: P4's 12 parts. */
enum {
    TOILE_PART_INVALID = 0,
    TOILE_PART_HEAD = 1,
    TOILE_PART_TORSO = 2,
    TOILE_PART_LEFT_UPPER_ARM = 3,
    TOILE_PART_LEFT_LOWER_ARM = 4,
    TOILE_PART_RIGHT_UPPER_ARM = 5,
    TOILE_PART_RIGHT_LOWER_ARM = 6,
    TOILE_PART_LEFT_UPPER_LEG = 7,
    TOILE_PART_LEFT_LOWER_LEG = 8,
    TOILE_PART_RIGHT_UPPER_LEG = 9,
    TOILE_PART_RIGHT_LOWER_LEG = 10,
    TOILE_PART_PELVIS = 11,
    TOILE_PART_NECK = 12
};

typedef struct toile_landmark {
    const char* name;
    uint32_t vertex, reserved;
} toile_landmark;

typedef struct toile_measurement {
    const char* name; /* ISO 8559-1 in snake_case: "waist_girth"                           */
    float value;      /* metres                                                            */
    float confidence; /* [0,1]                                                             */
} toile_measurement;

/* Shape: immutable once made; a new shape is a new body with a new revision. */
typedef struct toile_body {
    uint32_t size, reserved;
    uint64_t revision;        /* never 0; equal revisions mean equal bodies                */
    const char* model_id;     /* "mannequin"; empty for a free mesh                        */
    toile_view coefficients;  /* F32 (nc) shape coefficients, or count 0                   */
    toile_mesh rest;          /* rest surface: A pose, feet on y = 0, faces +Z             */
    toile_view rest_joints;   /* F32X3 (22) joint positions in the rest pose; at rest every
                                 joint's axes are the world's                              */
    toile_view joint_indices; /* U16X4 (nv)                                                */
    toile_view joint_weights; /* F32X4 (nv), each row sums to 1                            */
    toile_view part_labels;   /* U8 (nv), TOILE_PART_*                                     */
    toile_view landmarks;     /* STRUCT toile_landmark, or count 0                         */
    toile_view measurements;  /* STRUCT toile_measurement, or count 0                      */
} toile_body;

enum {
    TOILE_TRACKING_INVALID = 0,
    TOILE_TRACKING_DETECTED = 1,
    TOILE_TRACKING_TRACKED = 2,
    TOILE_TRACKING_UNCERTAIN = 3,
    TOILE_TRACKING_LOST = 4
};

/* world_from_joint; the rotation is the identity in the rest pose. */
typedef struct toile_joint {
    float position[3];
    float rotation[4];         /* x y z w                                                  */
    float linear_velocity[3];  /* m/s, 0 when unknown                                      */
    float angular_velocity[3]; /* rad/s, 0 when unknown                                    */
    float confidence;          /* [0,1]; 0 = not seen                                      */
} toile_joint;

/* What moves: one person in one frame. */
typedef struct toile_body_state {
    uint32_t size;
    uint32_t person_id;     /* stable over a run, never 0                                 */
    uint32_t tracking;      /* TOILE_TRACKING_*                                           */
    uint32_t sequence;      /* of the frame it was made from                              */
    int64_t timestamp_ns;   /* capture time of that frame                                 */
    uint64_t body_revision; /* the toile_body that it poses                               */
    toile_view joints;      /* STRUCT toile_joint (22)                                    */
    toile_view positions;   /* F32X3 (nv) posed surface, or count 0 before skinning       */
    toile_view normals;     /* F32X3 (nv), or count 0                                     */
} toile_body_state;

#ifdef __cplusplus
}
#endif
#endif
