/* Where the probe is touched, from a force-torque sensor, in a controller's own loop.
 *
 * A bundle is the folder that contactbench exports: contactbench.json, probe.ply and what else it names. A zip
 * archive is unpacked first.
 *
 * Units: N, N*m, m, s; the sensor's frame S. R_WS turns S into W (v_W = R_WS v_S), row major.
 * W: the frame that the orientations of the calibration were given in, normally the robot's base. It need not be
 * level: the bundle holds gravity in it. R_WS from any other frame leaves part of the tool's weight in the force.
 * Threads: each function says what it may run beside. "One thread": only one call at a time on one cb_runtime;
 * different ones are independent. "Any thread": beside whatever else.
 * Structs begin with their size. Set it by the INIT macros, or to sizeof: later versions of the library add members at
 * the end, and fill in as many as your size has room for. Smaller than in version 2.0 is refused.
 * Memory: nothing is allocated or freed between cb_open and cb_close.
 * No function throws; NULL is refused, never followed.
 * Floating point: whatever the caller set (rounding, traps, flushing of small numbers), each call computes with the
 * defaults of IEEE 754, gives the same bits, and leaves the caller's environment and raised flags as they were. No
 * function looks at the locale.
 */
#ifndef CONTACTBENCH_RUNTIME_H
#define CONTACTBENCH_RUNTIME_H

#include <math.h>
#include <stdint.h>

#if defined(__GNUC__)
#define CB_API __attribute__((visibility("default")))
#else
#define CB_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define CB_RUNTIME_VERSION "2.6.0"
#define CB_BUNDLE_VERSION 4 /* of contactbench.json; older ones are read, too */

typedef struct cb_runtime cb_runtime;

/* What cb_open, or a wrong call, says. */
enum {
    CB_OK = 0,
    CB_ERROR_ARGUMENT = 1,  /* NULL, or a struct that is too small */
    CB_ERROR_FILE = 2,      /* missing, unreadable or too large */
    CB_ERROR_JSON = 3,      /* contactbench.json is not well-formed */
    CB_ERROR_SCHEMA = 4,    /* another schema, or a field missing, unknown or of the wrong type */
    CB_ERROR_VERSION = 5,   /* written by another version */
    CB_ERROR_VALUE = 6,     /* out of range, or without physical sense */
    CB_ERROR_HASH = 7,      /* a file is not the one that was exported */
    CB_ERROR_MESH = 8,      /* probe.ply is not a mesh, or not the one described */
    CB_ERROR_MEMORY = 9,
    CB_ERROR_PROCESSOR = 10, /* the library was built for a newer one */
    CB_ERROR_SELF_TEST = 11  /* cb_selftest: no test vectors, or this library answers otherwise */
};

/* Why a contact was, or was not, given: cb_contact.reason. Act only where cb_contact.accepted is 1: for CB_OK_FACET and
 * CB_VERTEX, and for CB_BY_REGION unless the bundle says otherwise (gates.accept_by_region). */
enum {
    CB_NO_ANSWER = -1, /* no sample was looked at: cb_update was not called, or failed */
    CB_OK_FACET = 0,
    CB_VERTEX = 1,
    CB_AMBIGUOUS = 2,      /* another place is nearly as likely; the likeliest is given */
    CB_LOW_FORCE = 3,
    CB_TANGENTIAL = 4,     /* only a touch beyond the friction cone would explain the wrench */
    CB_OFF_SURFACE = 5,    /* no facet faces the force */
    CB_OUTSIDE_REGION = 6, /* the likeliest place is in no region, and gates.region_only is set */
    CB_SATURATED = 7,      /* a raw channel is at its limit; the filters hold */
    CB_STALE = 8,          /* the time did not increase; the sample was not used (but see cb_reset) */
    CB_NOT_FINITE = 9,     /* NaN or infinity in the sample; it was not used. Also for what a sensor flags: give NaN */
    CB_NOT_A_ROTATION = 10, /* R_WS is off by more than 1e-3; the sample was not used */
    CB_BY_REGION = 11,      /* sure only because of the declared regions */
    CB_IMPLAUSIBLE = 12,    /* no single touch explains the wrench: `misfit`, `left_over` and `arm` say by how much */
    CB_TWO_TOUCHES = 13,    /* a second touch has joined the one that was followed: `point` and `second` */
    CB_UNHEALTHY = 14,      /* `health` says why: the sensor hangs, or its clock has just leapt; the filters hold */
    CB_UNCERTAIN = 15       /* one place, but its largest sigma is over gates.sigma_max_m of the bundle; since 2.3 */
};

/* Bits of cb_contact.health; 0: nothing is wrong. What is unhealthy is never accepted. */
enum {
    CB_HEALTH_FROZEN = 1,  /* all six channels repeat beyond chance: the sensor hangs */
    CB_HEALTH_SILENT = 2,  /* cb_check: no sample comes */
    CB_HEALTH_FLAGGED = 4, /* the sensor itself says that the reading is no good */
    CB_HEALTH_NO_POSE = 8, /* cb_update_sample: no pose is young enough */
    CB_HEALTH_CLOCK = 16   /* CB_FLAG_CLOCK: when this was measured is a guess */
};

/* What the facet of a contact is: cb_contact.on. It changes no contact, and says nothing of `accepted`. */
enum {
    CB_ON_NOTHING = -1,    /* no facet */
    CB_ON_MEASURED = 0,    /* of the mesh file */
    CB_ON_INVENTED = 1,    /* made up where the mesh file had an opening: the place is a guess */
    CB_ON_UNTOUCHABLE = 2  /* of a region that nothing can touch */
};

/* Bits of cb_sample.flags: what the sensor says of a reading. */
enum {
    CB_FLAG_OVERRANGE = 1, /* a channel is at its limit */
    CB_FLAG_INVALID = 2,   /* the numbers are no measurement */
    CB_FLAG_RAW = 4,       /* not calibrated by the sensor */
    CB_FLAG_LATE = 8,      /* the sensor cannot keep its rate; the reading counts */
    CB_FLAG_ERROR = 16,
    CB_FLAG_CLOCK = 32     /* the sensor's clock or count has just leapt */
};

/* What is known of the sensor's zero: cb_zero.state. Only CB_ZERO_OFF is an alarm. */
enum {
    CB_ZERO_UNKNOWN = 0,   /* no moment without touch so far: count from the calibration */
    CB_ZERO_CONFIRMED = 1, /* right, `age` seconds ago */
    CB_ZERO_DOUBTFUL = 2,  /* off, unless something touches the probe: lift it clear and tilt it */
    CB_ZERO_OFF = 3        /* off by more than noise and calibration explain: calibrate again */
};

/* Is what was seen of the zero taken off the readings? cb_zero.follows. Since 2.4 */
enum {
    CB_FOLLOWS_OFF = 0,       /* the bundle does not say so (zero.follow) */
    CB_FOLLOWS_WAITING = 1,   /* no moment without touch so far: lift the probe for half a second */
    CB_FOLLOWS_FOLLOWING = 2,
    CB_FOLLOWS_STOPPED = 3    /* something leans on the probe, or the zero is too far off: nothing new is taken off */
};

/* Start as CB_ERROR_INIT, or give NULL. `message` names the file, the field and the remedy. Where `size` is too
 * small, cb_open returns NULL and writes nothing: not a word of why. */
typedef struct {
    uint32_t size;
    int32_t code;
    char message[512];
} cb_error;

/* Start as CB_CONTACT_INIT: zeros would read as a contact. NaN and -1 stand for what there is none of. */
typedef struct {
    uint32_t size;
    int32_t reason;
    int32_t accepted;     /* 1: act on it; 0: do not, whatever else is there */
    int32_t face, vertex; /* vertex: when the contact is on one */
    int32_t region;       /* rank, 0 for none */
    int32_t candidates;   /* the chosen one included */
    uint32_t health;      /* bits CB_HEALTH_*; 0: well */
    double time;
    double point[3], normal[3]; /* outward */
    double torque_about_normal; /* local torque k on the probe, k * normal */
    double force[3], torque[3]; /* on the probe, about the origin of S: compensated, filtered */
    double covariance[9];       /* of `point`, m^2; not for CB_TWO_TOUCHES */
    double filtered_point[3];   /* low-passed; held while contact is lost for a moment */
    double misfit;       /* of the best touch, in standard deviations squared: about 1 where the model is right */
    double left_over;    /* torque that the best touch does not explain, N*m */
    double arm;          /* torque along the force over the force, m: for one touch, a few mm at most */
    double confidence;   /* 1 / (1 + the odds of every other place): 0 to 1, no probability */
    double runner_up[3]; /* the likeliest other place */
    double second[3];    /* of CB_TWO_TOUCHES, the touch that joined */
    double pose_age;     /* s: how much older than the sample the last pose before it is */
    double latency;      /* s: arrival less time, and the age of the filtered wrench at that time */
    int32_t on;          /* CB_ON_*: what the facet is. Since 2.2 */
    int32_t reserved;
    double within;       /* m: how far the 95 % ellipse of `point` reaches, 2.45 of its largest sigma. Since 2.3 */
    double torsion_arm;   /* m: torsion over force, 1 sigma, that it was judged by. Since 2.3 */
    double torsion_since; /* s: for how long that was learned of this touch; NaN: the bundle declares it. Since 2.3 */
    double raw[6];       /* as the sensor reads it, where it was used. Since 2.4 */
    double taken[6];     /* off the compensated wrench, because the zero follows; zeros where it does not. Since 2.4 */
} cb_contact;

/* A raw reading Fx Fy Fz Mx My Mz. Start as CB_SAMPLE_INIT. */
typedef struct {
    uint32_t size;
    uint32_t flags; /* bits CB_FLAG_* */
    double wrench[6];
    double time;    /* when it was measured, s */
    double arrival; /* when it came, on the same clock; NaN: not known */
} cb_sample;

/* Start as CB_ZERO_INIT. NaN stands for what is not known. */
typedef struct {
    uint32_t size;
    int32_t state;                     /* CB_ZERO_* */
    double age;                        /* s, at the last sample: since the last moment without touch */
    double force[3], torque[3];        /* what the readings have too much, N and N*m in S */
    double force_sigma[3], torque_sigma[3]; /* one standard deviation, the calibration's share included */
    double shift, shift_sigma;         /* m: by how much that moves a contact of 10 N, where it does so most */
    /* Since 2.4: what is taken off now, one standard deviation of it, and how long ago it was last seen, s. */
    int32_t follows, reserved;         /* CB_FOLLOWS_* */
    double taken[6], taken_sigma[6];
    double seen;
} cb_zero;

#define CB_ERROR_INIT {sizeof(cb_error), CB_OK, ""}
#define CB_CONTACT_INIT                                                                                             \
    {                                                                                                               \
        sizeof(cb_contact), CB_NO_ANSWER, 0, -1, -1, 0, 0, 0, 0.0, {0.0}, {0.0}, 0.0, {0.0}, {0.0}, {0.0}, {0.0},   \
            0.0, 0.0, 0.0, 0.0, {0.0}, {0.0}, 0.0, 0.0, CB_ON_NOTHING, 0, 0.0, 0.0, 0.0, {0.0}, {0.0}              \
    }
#define CB_SAMPLE_INIT {sizeof(cb_sample), 0, {0.0}, 0.0, (double)NAN}

#define CB_ZERO_INIT                                                                                                \
    {sizeof(cb_zero), CB_ZERO_UNKNOWN, 0.0, {0.0}, {0.0}, {0.0}, {0.0}, 0.0, 0.0, CB_FOLLOWS_OFF, 0, {0.0}, {0.0}, 0.0}

/* Set `size` to sizeof(cb_info). */
typedef struct {
    uint32_t size;
    int32_t verified; /* 1: the figures of this probe were measured and passed */
    int32_t facets, vertices;
    double rate_Hz; /* what your samples have to come at: filters, noise and figures belong to it */
    double max_age_s, max_force_N, max_torque_Nm;
    char sensor_model[128], sensor_serial[128], probe[128]; /* cut short where they are longer */
    char doubt[512]; /* why it is not verified: other gates or filters than were, say; UTF-8, cut short. Since 2.6 */
} cb_info;

/* Admittance along S's z axis, M x'' + D x' + K x = error in N, and about its x and y axes (in this order), where the
 * error is desired_force_N times how far the contact is off, N*m. Set `size` to sizeof(cb_controller). A bundle of
 * version 1 has one gain for both turns; it says nothing of the rest, which then is as contactbench takes it. Limits
 * of infinity are none. */
typedef struct {
    uint32_t size;
    int32_t aware;    /* 1: the tissue's motion is estimated and led; 0: plain */
    int32_t attempts; /* how often it approaches again after tissue was lost */
    int32_t reserved;
    double desired_force_N, period_s, servo_lag_s;
    double force_mass_kg, force_damping_Nspm, force_stiffness_Npm, force_gain_per_s;
    double angle_inertia[2], angle_damping[2], angle_stiffness[2], angle_gain_per_s[2];
    double settling_s;
    double bandwidth_per_s[3]; /* of the place, the tilt about x, the tilt about y */
    double smoothing_s, lean_rad, lean_s;
    double approach_speed_mps, approach_travel_m, retract_speed_mps, retract_travel_m;
    double touch_force_N, low_force_N, ramp_s, probing_m;
    double left_force_N, left_torque_Nm, taring_s, gyration_m;
    double stale_s, give_up_s, following_s, max_tilt_rad;
    double max_force_N, max_torque_Nm, max_speed_mps, max_turn_radps; /* limits: also for other controllers */
} cb_controller;

/* Returns NULL after a failure, with `error` filled in. Any thread. */
CB_API cb_runtime* cb_open(const char* bundle_folder, cb_error* error);

/* Loads the bundle and replays its test vectors (docs/bundle.md): some 300 samples, a few milliseconds. Returns CB_OK where
 * every answer is the one that the export gave, else a code, and `error` names the first difference. Any thread. */
CB_API int cb_selftest(const char* bundle_folder, cb_error* error);

/* With an orientation of your own, R_WS at `time`, and one raw reading Fx Fy Fz Mx My Mz. Returns CB_OK when `contact`
 * was filled in: its reason says the rest. After a failure its reason is CB_NO_ANSWER, `accepted` is 0, and nothing else
 * of it was written. One thread. */
CB_API int cb_update(cb_runtime* runtime, const double wrench[6], const double R_WS[9], double time,
                     cb_contact* contact);

/* Or leave the orientation to the library: give poses as they come, each with its time, then samples. A sample takes the
 * pose at its own time, between two poses or carried on from the last, as far as the bundle allows (docs/bundle.md).
 *
 * R turns the flange into W where the bundle knows the mounting, else the sensor; p_W: position of that frame, m, or NULL.
 * With positions the tool's inertia is taken off the readings, where the bundle says so. CB_ERROR_VALUE: not used, for it
 * is no rotation, not finite, or not later than the one before. One thread. */
CB_API int cb_pose(cb_runtime* runtime, const double R[9], const double* p_W, double time);
/* As cb_update; where no pose is young enough the reason is CB_STALE. One thread. */
CB_API int cb_update_sample(cb_runtime* runtime, const cb_sample* sample, cb_contact* contact);
/* To be called while nothing comes: `now` on the samples' clock, s. Returns CB_OK and a contact with CB_STALE and
 * CB_HEALTH_SILENT where samples have stopped, or never came; CB_OK and CB_NO_ANSWER while they come. One thread. */
CB_API int cb_check(const cb_runtime* runtime, double now, cb_contact* contact);

/* How old the sensor's zero is, and how far it is off: watched in the moments in which nothing touches the probe, at most
 * twice a second; and what of it is taken off, where the bundle says so. One thread. */
CB_API int cb_check_zero(const cb_runtime* runtime, cb_zero* zero);

/* The two as one line of JSON, with its end and a 0 behind it: what contactbench-locate and `contactbench run` write.
 * `room`: of `text`; CB_LINE_ROOM is enough. Returns its length, or 0 where that does not fit or an argument is wrong.
 * Any thread. Since 2.5 */
#define CB_LINE_ROOM 4096
CB_API int cb_line(const cb_contact* contact, const cb_zero* zero, char* text, uint32_t room);

/* R_WS from the flange's orientation R_WE, by the mounting that the bundle holds; CB_ERROR_VALUE where it holds
 * none and R_WS has to come from elsewhere. Any thread. */
CB_API int cb_sensor_rotation(const cb_runtime* runtime, const double R_WE[9], double R_WS[9]);
/* Any thread. */
CB_API int cb_describe(const cb_runtime* runtime, cb_info* info);
/* CB_ERROR_VALUE where the bundle holds no controller: only the limits were then written. Any thread. */
CB_API int cb_describe_controller(const cb_runtime* runtime, cb_controller* controller);
/* The next sample and the next pose are the first ones, whatever their times: after a clock was set, or the tool was
 * changed. A time that lies in the future makes those after it stale; once stale times have increased without a break for
 * 50 samples, or for longer than max_age_s, the stream starts anew by itself. One thread. */
CB_API int cb_reset(cb_runtime* runtime);
/* The last call on it. One thread. */
CB_API void cb_close(cb_runtime* runtime);
/* Any thread. */
CB_API const char* cb_version(void);
CB_API const char* cb_reason_name(int reason);

#ifdef __cplusplus
}
#endif

#endif
