/* The table of quantities, as C needs it. Written from core/quantities.py by `python -m boreprop.kernel.generate`. */
#ifndef BOREPROP_QUANTITIES_H
#define BOREPROP_QUANTITIES_H

#include "problems.h"
#include <math.h>
#include <stddef.h>

/* clang-format off */

#define QUANTITIES_DIGEST "3b8cf1ab0c8b5d08" /* of this file, but for this line, and of problems.h */
#define MOST_DRILLED 100000.0 /* m in a communication step */
#define LEAST_SPAN 0.01 /* m between stabilizers, at least: forces between closer ones are rounding errors */
#define POINTS_ALONG_BHA 36 /* at which its distance from the hole is looked at */
#define OFTEN 0.125 /* of its length, at most, from look to look */

enum { MAX_STABILIZERS = 6, MAX_SECTIONS = 24, MAX_POINTS = 128 };
enum { MAX_SENSORS = 8 };
enum { PARAMETER_COUNT = 18, INPUT_COUNT = 10, OUTPUT_COUNT = 39 };

/* How a drilling system is made up, which says how many values each quantity has. */
typedef struct {
    int n, sections; /* numbers of stabilizers and of sections */
    int axial;       /* whether the load along the beam counts */
    int points;      /* number of points at which the body between the stabilizers may touch the wall */
    int layered;     /* whether rock comes in layers by true vertical depth */
    int sensors;     /* their number */
    int space;       /* whether the hole may leave its vertical plane */
} Structure;

/* The parameters, in SI units. */
typedef struct {
    Structure structure;
    double stabilizer_position[MAX_STABILIZERS]; /* m: distance of the stabilizer from the bit; the last one is ideal */
    double stabilizer_clearance[MAX_STABILIZERS - 1]; /* m: clearance between stabilizer and wall on each side */
    double rss_position; /* m: distance of the steering pads from the bit */
    double distributed_weight; /* N/m: buoyant weight of the BHA per length */
    double flexural_stiffness; /* N.m2: bending stiffness of the BHA */
    double section_length[MAX_SECTIONS]; /* m: length of a section of the BHA, from the bit up */
    double section_distributed_weight[MAX_SECTIONS]; /* N/m: buoyant weight of the section per length */
    double section_flexural_stiffness[MAX_SECTIONS]; /* N.m2: bending stiffness of the section */
    double body_point_position[MAX_POINTS]; /* m: where the body between the stabilizers may touch the wall, from the bit */
    double body_point_clearance[MAX_POINTS]; /* m: clearance between the body there and the wall on each side */
    double end_deflection; /* m: offset of the BHA from the borehole axis at the last stabilizer, positive to the high side */
    double sensor_position[MAX_SENSORS]; /* m: distance of the sensor from the bit */
    double sensor_interval[MAX_SENSORS]; /* m: drilled length from reading to reading of the inclination; 0: it is read all the time */
    double sensor_bias[MAX_SENSORS]; /* rad: what is always added to a reading */
    double sensor_noise[MAX_SENSORS]; /* rad: standard deviation of what is added to each reading */
    double sensor_seed[MAX_SENSORS]; /* which noise: the same seed gives the same readings again */
    double sensor_body_clearance[MAX_SENSORS]; /* m: clearance between the body at the sensor, where it is centred, and the wall on each side */
    double relative_tolerance; /* local error allowed in one step of the integrator, relative to 1 rad and ℓ₁ */
} System;

/* The inputs from where the bit is: their values, and the change of some per metre drilled. */
typedef struct {
    double rss_force; /* N: force of the steering pads on the BHA, positive builds */
    double rss_force_slope; /* N/m: its change per metre drilled */
    double active_weight_on_bit; /* N: weight on bit that goes into drilling */
    double active_weight_on_bit_slope; /* N/m: its change per metre drilled */
    double lateral_steering_resistance; /* lateral over axial drilling resistance */
    double lateral_steering_resistance_slope; /* /m: its change per metre drilled */
    double angular_steering_resistance; /* angular over axial drilling resistance */
    double angular_steering_resistance_slope; /* /m: its change per metre drilled */
    double bit_tilt_limit; /* rad: tilt at which the bit gauge meets the wall */
    double bit_tilt_limit_slope; /* rad/m: its change per metre drilled */
    double weight_on_bit; /* N: all of the weight on bit, which presses the BHA along its axis; 0: the active weight */
    double bit_walk_angle; /* rad: walk angle: from the lateral penetration of the bit to the lateral force, positive from the high side to the right looking down the hole */
    double rss_toolface; /* rad: side to which the pads push, looking down the hole: 0 up or north, π/2 to the right */
    double toolface_reference; /* from where the toolface counts: 0 from the high side, 1 from north, 2 from the frame of the bit */
} Inputs;

/* How many values a quantity has. */
typedef enum { ONE, EACH_STABILIZER, EACH_NON_IDEAL, IF_UNIFORM, EACH_SECTION, IF_STEPPED, IF_AXIAL, EACH_POINT, IF_POINTS, IF_LAYERED, EACH_SENSOR, IF_SPACE, EACH_NON_IDEAL_IN_SPACE, EACH_SENSOR_IN_SPACE, IF_POINTS_IN_SPACE } Size;

/* A parameter or input, and its range: above < value, at_least <= value <= at_most. */
typedef struct {
    Name name;
    Size size;
    size_t offset; /* of a parameter, in System */
    int is_whole;
    double above, at_least, at_most;
} Quantity;

static const Quantity PARAMETER_TABLE[PARAMETER_COUNT] = {
    {Q_STABILIZER_POSITION, EACH_STABILIZER, offsetof(System, stabilizer_position), 0, 0.0, -INFINITY, INFINITY},
    {Q_STABILIZER_CLEARANCE, EACH_NON_IDEAL, offsetof(System, stabilizer_clearance), 0, -INFINITY, 0.0, INFINITY},
    {Q_RSS_POSITION, ONE, offsetof(System, rss_position), 0, -INFINITY, 0.0, INFINITY},
    {Q_DISTRIBUTED_WEIGHT, IF_UNIFORM, offsetof(System, distributed_weight), 0, -INFINITY, 0.0, INFINITY},
    {Q_FLEXURAL_STIFFNESS, IF_UNIFORM, offsetof(System, flexural_stiffness), 0, 0.0, -INFINITY, INFINITY},
    {Q_SECTION_LENGTH, EACH_SECTION, offsetof(System, section_length), 0, 0.0, -INFINITY, INFINITY},
    {Q_SECTION_DISTRIBUTED_WEIGHT, EACH_SECTION, offsetof(System, section_distributed_weight), 0, -INFINITY, 0.0, INFINITY},
    {Q_SECTION_FLEXURAL_STIFFNESS, EACH_SECTION, offsetof(System, section_flexural_stiffness), 0, 0.0, -INFINITY, INFINITY},
    {Q_BODY_POINT_POSITION, EACH_POINT, offsetof(System, body_point_position), 0, 0.0, -INFINITY, INFINITY},
    {Q_BODY_POINT_CLEARANCE, EACH_POINT, offsetof(System, body_point_clearance), 0, 0.0, -INFINITY, INFINITY},
    {Q_END_DEFLECTION, IF_STEPPED, offsetof(System, end_deflection), 0, -INFINITY, -INFINITY, INFINITY},
    {Q_SENSOR_POSITION, EACH_SENSOR, offsetof(System, sensor_position), 0, -INFINITY, 0.0, INFINITY},
    {Q_SENSOR_INTERVAL, EACH_SENSOR, offsetof(System, sensor_interval), 0, -INFINITY, 0.0, INFINITY},
    {Q_SENSOR_BIAS, EACH_SENSOR, offsetof(System, sensor_bias), 0, -INFINITY, -3.141592653589793, 3.141592653589793},
    {Q_SENSOR_NOISE, EACH_SENSOR, offsetof(System, sensor_noise), 0, -INFINITY, 0.0, 3.141592653589793},
    {Q_SENSOR_SEED, EACH_SENSOR, offsetof(System, sensor_seed), 1, -INFINITY, 0.0, 2147483647.0},
    {Q_SENSOR_BODY_CLEARANCE, EACH_SENSOR, offsetof(System, sensor_body_clearance), 0, -INFINITY, 0.0, INFINITY},
    {Q_RELATIVE_TOLERANCE, ONE, offsetof(System, relative_tolerance), 0, -INFINITY, 1e-12, 0.01},
};

typedef enum { IN_RSS_FORCE, IN_ACTIVE_WEIGHT_ON_BIT, IN_RATE_OF_PENETRATION, IN_LATERAL_STEERING_RESISTANCE, IN_ANGULAR_STEERING_RESISTANCE, IN_BIT_TILT_LIMIT, IN_WEIGHT_ON_BIT, IN_BIT_WALK_ANGLE, IN_RSS_TOOLFACE, IN_TOOLFACE_REFERENCE } Input;
static const Quantity INPUT_TABLE[INPUT_COUNT] = {
    {Q_RSS_FORCE, ONE, 0, 0, -INFINITY, -INFINITY, INFINITY},
    {Q_ACTIVE_WEIGHT_ON_BIT, ONE, 0, 0, 0.0, -INFINITY, INFINITY},
    {Q_RATE_OF_PENETRATION, ONE, 0, 0, -INFINITY, 0.0, INFINITY},
    {Q_LATERAL_STEERING_RESISTANCE, ONE, 0, 0, 0.0, -INFINITY, INFINITY},
    {Q_ANGULAR_STEERING_RESISTANCE, ONE, 0, 0, 0.0, -INFINITY, INFINITY},
    {Q_BIT_TILT_LIMIT, ONE, 0, 0, 0.0, -INFINITY, 1.5707963267948966},
    {Q_WEIGHT_ON_BIT, IF_AXIAL, 0, 0, -INFINITY, 0.0, INFINITY},
    {Q_BIT_WALK_ANGLE, IF_SPACE, 0, 0, -INFINITY, -1.5533430342749532, 1.5533430342749532},
    {Q_RSS_TOOLFACE, IF_SPACE, 0, 0, -INFINITY, -6.283185307179586, 6.283185307179586},
    {Q_TOOLFACE_REFERENCE, IF_SPACE, 0, 1, -INFINITY, 0.0, 2.0},
};

/* The outputs, in their order. */
typedef enum {
    OUT_DRILLED_LENGTH, /* m: length drilled since the start of the run */
    OUT_BIT_INCLINATION, /* rad: inclination of the bit axis from the downward vertical */
    OUT_BOREHOLE_INCLINATION, /* rad: inclination of the borehole at the bit */
    OUT_BIT_TILT, /* rad: bit inclination minus borehole inclination */
    OUT_AVERAGE_INCLINATION, /* rad: borehole inclination averaged between stabilizers i−1 and i */
    OUT_STABILIZER_DEFLECTION, /* m: offset of the BHA from the borehole axis, positive to the high side */
    OUT_STABILIZER_FORCE, /* N: force of the wall on the stabilizer, positive from the lower wall */
    OUT_STABILIZER_CONTACT, /* 1 on the lower wall, −1 on the upper wall, 0 free */
    OUT_BIT_TILT_SATURATION, /* 1 at +ψ*, −1 at −ψ*, 0 between */
    OUT_BIT_LATERAL_FORCE, /* N: lateral force on the bit */
    OUT_BIT_MOMENT, /* N.m: moment on the bit */
    OUT_BOREHOLE_CURVATURE, /* rad/m: change of borehole inclination over the last ℓ₁, per length */
    OUT_BODY_CONTACT_FORCE, /* N: largest force of the wall on the body between the stabilizers, positive from the lower wall */
    OUT_BODY_CONTACT_POSITION, /* m: where that force acts, from the bit; 0 if the body touches no wall */
    OUT_WALL_DISTANCE, /* m: least distance of the body from the wall */
    OUT_BODY_CONTACT_FORCE_HIGH, /* N: part of that force to the high side, in a nearly vertical hole to north */
    OUT_BODY_CONTACT_FORCE_RIGHT, /* N: part of that force to the right of that, looking down the hole */
    OUT_BIT_AZIMUTH, /* rad: azimuth of the bit axis, from north over east */
    OUT_BOREHOLE_AZIMUTH, /* rad: azimuth of the borehole at the bit, from north over east */
    OUT_BIT_TILT_HIGH, /* rad: part of the bit tilt to the high side, in a nearly vertical hole to north */
    OUT_BIT_TILT_RIGHT, /* rad: part of the bit tilt to the right of that, looking down the hole */
    OUT_BIT_LATERAL_FORCE_HIGH, /* N: part of the lateral force on the bit to the high side, in a nearly vertical hole to north */
    OUT_BIT_LATERAL_FORCE_RIGHT, /* N: part of the lateral force on the bit to the right of that, looking down the hole */
    OUT_STABILIZER_FORCE_HIGH, /* N: part of the force of the wall on the stabilizer to the high side, in a nearly vertical hole to north */
    OUT_STABILIZER_FORCE_RIGHT, /* N: part of the force of the wall on the stabilizer to the right of that, looking down the hole */
    OUT_STABILIZER_DEFLECTION_HIGH, /* m: part of the offset of the BHA from the borehole axis to the high side, in a nearly vertical hole to north */
    OUT_STABILIZER_DEFLECTION_RIGHT, /* m: part of the offset of the BHA from the borehole axis to the right of that, looking down the hole */
    OUT_NORTH, /* m: position of the bit north of the start of the run */
    OUT_EAST, /* m: position of the bit east of the start of the run */
    OUT_SENSOR_INCLINATION, /* rad: inclination of the BHA at the sensor; with an interval its last reading, with bias and noise */
    OUT_SENSOR_BENDING_MOMENT, /* N.m: bending moment of the BHA at the sensor, positive as in a hole that builds; at the bit the moment on the bit */
    OUT_SENSOR_CLEARANCE, /* m: distance of the body at the sensor from the wall; negative beyond it */
    OUT_SENSOR_AZIMUTH, /* rad: azimuth of the BHA at the sensor, from north over east; with an interval its last reading, with noise */
    OUT_SENSOR_BENDING_MOMENT_HIGH, /* N.m: part of the bending moment at the sensor that bends the BHA to the high side, in a nearly vertical hole to north */
    OUT_SENSOR_BENDING_MOMENT_RIGHT, /* N.m: part of the bending moment at the sensor that bends the BHA to the right of that, looking down the hole */
    OUT_DISPLACEMENT, /* m: horizontal position of the bit from the start of the run */
    OUT_TRUE_VERTICAL_DEPTH, /* m: depth of the bit below the start of the run */
    OUT_ETA_PI, /* lateral penetration stiffness of the rock over the BHA's bending stiffness */
    OUT_FORMATION, /* number of the formation by true vertical depth in which the bit is, from the top; 0 above the first */
} Output;
#define EACH_OUTPUT(of) of(OUT_DRILLED_LENGTH) of(OUT_BIT_INCLINATION) of(OUT_BOREHOLE_INCLINATION) of(OUT_BIT_TILT) of(OUT_AVERAGE_INCLINATION) of(OUT_STABILIZER_DEFLECTION) of(OUT_STABILIZER_FORCE) of(OUT_STABILIZER_CONTACT) of(OUT_BIT_TILT_SATURATION) of(OUT_BIT_LATERAL_FORCE) of(OUT_BIT_MOMENT) of(OUT_BOREHOLE_CURVATURE) of(OUT_BODY_CONTACT_FORCE) of(OUT_BODY_CONTACT_POSITION) of(OUT_WALL_DISTANCE) of(OUT_BODY_CONTACT_FORCE_HIGH) of(OUT_BODY_CONTACT_FORCE_RIGHT) of(OUT_BIT_AZIMUTH) of(OUT_BOREHOLE_AZIMUTH) of(OUT_BIT_TILT_HIGH) of(OUT_BIT_TILT_RIGHT) of(OUT_BIT_LATERAL_FORCE_HIGH) of(OUT_BIT_LATERAL_FORCE_RIGHT) of(OUT_STABILIZER_FORCE_HIGH) of(OUT_STABILIZER_FORCE_RIGHT) of(OUT_STABILIZER_DEFLECTION_HIGH) of(OUT_STABILIZER_DEFLECTION_RIGHT) of(OUT_NORTH) of(OUT_EAST) of(OUT_SENSOR_INCLINATION) of(OUT_SENSOR_BENDING_MOMENT) of(OUT_SENSOR_CLEARANCE) of(OUT_SENSOR_AZIMUTH) of(OUT_SENSOR_BENDING_MOMENT_HIGH) of(OUT_SENSOR_BENDING_MOMENT_RIGHT) of(OUT_DISPLACEMENT) of(OUT_TRUE_VERTICAL_DEPTH) of(OUT_ETA_PI) of(OUT_FORMATION)
static const Size OUTPUT_SIZE[OUTPUT_COUNT] = {
    ONE, /* drilled_length */
    ONE, /* bit_inclination */
    ONE, /* borehole_inclination */
    ONE, /* bit_tilt */
    EACH_STABILIZER, /* average_inclination */
    EACH_NON_IDEAL, /* stabilizer_deflection */
    EACH_NON_IDEAL, /* stabilizer_force */
    EACH_NON_IDEAL, /* stabilizer_contact */
    ONE, /* bit_tilt_saturation */
    ONE, /* bit_lateral_force */
    ONE, /* bit_moment */
    ONE, /* borehole_curvature */
    IF_POINTS, /* body_contact_force */
    IF_POINTS, /* body_contact_position */
    IF_POINTS, /* wall_distance */
    IF_POINTS_IN_SPACE, /* body_contact_force_high */
    IF_POINTS_IN_SPACE, /* body_contact_force_right */
    IF_SPACE, /* bit_azimuth */
    IF_SPACE, /* borehole_azimuth */
    IF_SPACE, /* bit_tilt_high */
    IF_SPACE, /* bit_tilt_right */
    IF_SPACE, /* bit_lateral_force_high */
    IF_SPACE, /* bit_lateral_force_right */
    EACH_NON_IDEAL_IN_SPACE, /* stabilizer_force_high */
    EACH_NON_IDEAL_IN_SPACE, /* stabilizer_force_right */
    EACH_NON_IDEAL_IN_SPACE, /* stabilizer_deflection_high */
    EACH_NON_IDEAL_IN_SPACE, /* stabilizer_deflection_right */
    IF_SPACE, /* north */
    IF_SPACE, /* east */
    EACH_SENSOR, /* sensor_inclination */
    EACH_SENSOR, /* sensor_bending_moment */
    EACH_SENSOR, /* sensor_clearance */
    EACH_SENSOR_IN_SPACE, /* sensor_azimuth */
    EACH_SENSOR_IN_SPACE, /* sensor_bending_moment_high */
    EACH_SENSOR_IN_SPACE, /* sensor_bending_moment_right */
    ONE, /* displacement */
    ONE, /* true_vertical_depth */
    ONE, /* eta_pi */
    IF_LAYERED, /* formation */
};
static const Name OUTPUT_NAME[OUTPUT_COUNT] = {
    Q_DRILLED_LENGTH,
    Q_BIT_INCLINATION,
    Q_BOREHOLE_INCLINATION,
    Q_BIT_TILT,
    Q_AVERAGE_INCLINATION,
    Q_STABILIZER_DEFLECTION,
    Q_STABILIZER_FORCE,
    Q_STABILIZER_CONTACT,
    Q_BIT_TILT_SATURATION,
    Q_BIT_LATERAL_FORCE,
    Q_BIT_MOMENT,
    Q_BOREHOLE_CURVATURE,
    Q_BODY_CONTACT_FORCE,
    Q_BODY_CONTACT_POSITION,
    Q_WALL_DISTANCE,
    Q_BODY_CONTACT_FORCE_HIGH,
    Q_BODY_CONTACT_FORCE_RIGHT,
    Q_BIT_AZIMUTH,
    Q_BOREHOLE_AZIMUTH,
    Q_BIT_TILT_HIGH,
    Q_BIT_TILT_RIGHT,
    Q_BIT_LATERAL_FORCE_HIGH,
    Q_BIT_LATERAL_FORCE_RIGHT,
    Q_STABILIZER_FORCE_HIGH,
    Q_STABILIZER_FORCE_RIGHT,
    Q_STABILIZER_DEFLECTION_HIGH,
    Q_STABILIZER_DEFLECTION_RIGHT,
    Q_NORTH,
    Q_EAST,
    Q_SENSOR_INCLINATION,
    Q_SENSOR_BENDING_MOMENT,
    Q_SENSOR_CLEARANCE,
    Q_SENSOR_AZIMUTH,
    Q_SENSOR_BENDING_MOMENT_HIGH,
    Q_SENSOR_BENDING_MOMENT_RIGHT,
    Q_DISPLACEMENT,
    Q_TRUE_VERTICAL_DEPTH,
    Q_ETA_PI,
    Q_FORMATION,
};
static const int OUTPUT_IS_WHOLE[OUTPUT_COUNT] = { 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1 };
enum { MOST_PARAMETERS = 392, MOST_OUTPUTS = 114 }; /* values, of the largest assembly */

/* How the integrator takes its steps: core/options.py says what each is. */
typedef struct {
    double relative_tolerance, largest_step, smallest_step, layers, theta_weight, most_steps;
} Options;

static const Options USUAL_OPTIONS = {1e-07, 1.0, 1e-12, 16.0, 0.1, 262144.0};

/* clang-format on */

#endif
