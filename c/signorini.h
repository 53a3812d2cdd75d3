/** @file
 * The C API of Signorini: complementarity problems and contact problems, solved and certified.
 *
 * Stable: within one SOVERSION functions, enumerators and struct fields are only added. Structs
 * that the library fills are passed with their size, so that a program keeps working with a library
 * whose struct has grown at its end; structs that the library reads never change.
 *
 * Errors: functions that can fail return a signorini_error and leave their arguments as they were
 * (pointers to write to are then set to null, numbers are left alone). signorini_last_error() says
 * in words what was wrong, with the field, its value and the bound. No exception and no signal
 * crosses this interface. How a solve *ended* is not an error but its signorini_status.
 *
 * Getters accept null and answer null, 0, NaN or SIGNORINI_NOT_RUN to it.
 *
 * Pointers to arrays may be null where the array is empty. Whatever is handed in is copied before
 * the function returns; arrays that a getter hands out belong to the handle.
 *
 * Threads: a handle is for one thread at a time, different handles share nothing; solves of several
 * threads may read one problem at once while nobody changes it. signorini_last_error() is the
 * calling thread's own.
 *
 * Enumerations are int32_t, so that their width never changes and any number may be handed in.
 *
 * Counts are signed, so that a negative one is seen and refused. No function allocates more than a
 * small multiple of the memory that its (plausible) arguments occupy; counts whose memory could not
 * be addressed are refused before anything is read. */
#ifndef SIGNORINI_C_SIGNORINI_H
#define SIGNORINI_C_SIGNORINI_H

#include <stddef.h>
#include <stdint.h>

/** @cond */
#if defined(_WIN32)
#define SIGNORINI_API
#else
#define SIGNORINI_API __attribute__((visibility("default")))
#endif

/** @endcond */

#ifdef __cplusplus
extern "C" {
#endif

/** What was wrong with a call. */
typedef int32_t signorini_error;
enum {
  SIGNORINI_OK = 0,
  SIGNORINI_INVALID_ARGUMENT = 1, /**< nothing was changed; signorini_last_error() names it */
  SIGNORINI_OUT_OF_MEMORY = 2,    /**< nothing was changed; a result is not run */
  SIGNORINI_INTERNAL_ERROR = 3    /**< a defect of ours: please report it with its text */
};

/** The last error of the calling thread, one line, at most 1023 characters; "" if it had none.
 * Valid until the thread's next call that fails. */
SIGNORINI_API const char* signorini_last_error(void);

/** The library's version, for example "0.1.0". */
SIGNORINI_API const char* signorini_version(void);

/* ---- statuses ------------------------------------------------------------------------------- */

/** How a solve ended. Only the first two after NOT_RUN claim an answer; both are given by the
 * certificate, recomputed from the caller's data. In all other cases z is the best iterate
 * (NOT_RUN, INVALID_INPUT: NaN). */
typedef int32_t signorini_status;
enum {
  SIGNORINI_NOT_RUN = 0,
  SIGNORINI_SOLVED = 1,             /**< both residuals are within the tolerance */
  SIGNORINI_SOLVED_TO_ROUNDING = 2, /**< above it, but at most four rounding floors and 1e-5 */
  SIGNORINI_INFEASIBLE = 3,         /**< the ray proves that no z satisfies the bounds */
  SIGNORINI_NO_SOLUTION_BELOW = 4,  /**< the ray proves |z|_1 >= ray_bound for every feasible z */
  SIGNORINI_RAY_UNPROVEN = 5,       /**< ended on a ray that proves nothing */
  SIGNORINI_ITERATION_LIMIT = 6,
  SIGNORINI_TIME_LIMIT = 7,
  SIGNORINI_STALLED = 8,             /**< no more progress, short of the tolerance */
  SIGNORINI_NUMERICAL_BREAKDOWN = 9, /**< a pivot failed, or the certificate refused the answer */
  SIGNORINI_INVALID_INPUT = 10       /**< NaN, infinity or crossed bounds; detail says where */
};

/** "solved", "solved to rounding", ...; "unknown status" for any other number. */
SIGNORINI_API const char* signorini_status_text(signorini_status status);
/** 1 for SOLVED and SOLVED_TO_ROUNDING, else 0. */
SIGNORINI_API int signorini_is_solved(signorini_status status);

/* ---- problems ------------------------------------------------------------------------------- */

/** Find z and w = M z + q with, for every row, 0 <= z_i, 0 <= w_i, z_i w_i = 0; with bounds,
 * friction limits and cones where they are set. Units are the caller's: with z in N s and w in m/s
 * M is in 1/kg. A new problem has no rows. */
typedef struct signorini_problem signorini_problem;

/** How a matrix lies in memory. */
typedef int32_t signorini_order;
enum {
  SIGNORINI_COLUMN_MAJOR = 0, /**< dense: M_ij at [j n + i]; sparse: compressed columns (CSC) */
  SIGNORINI_ROW_MAJOR = 1     /**< dense: M_ij at [i n + j]; sparse: compressed rows (CSR) */
};

/** What the blocks of a factored problem are. */
typedef int32_t signorini_mass_kind;
enum {
  SIGNORINI_INVERSE_MASS = 0, /**< the blocks are W_k */
  SIGNORINI_MASS = 1          /**< the blocks are M_k = W_k^-1 */
};

/** What the rows of a friction cone must satisfy. */
typedef int32_t signorini_friction_law;
enum {
  SIGNORINI_COULOMB = 0,   /**< w + mu |w_T| n in the dual cone: Coulomb's law */
  SIGNORINI_ASSOCIATED = 1 /**< w in the dual cone: convex; sliding contacts separate */
};

/** The most rows of a dense M: n^2 fits 32 bits (17 GB). */
#define SIGNORINI_MAX_DENSE_ROWS 46340

/** A problem without rows. */
SIGNORINI_API signorini_error signorini_problem_create(signorini_problem** problem);
/** Null is allowed. */
SIGNORINI_API void signorini_problem_destroy(signorini_problem* problem);

/** Gives M (n x n, may be nonsymmetric) and q (n) anew; bounds, limits and cones are forgotten.
 * @param n 0 .. SIGNORINI_MAX_DENSE_ROWS */
SIGNORINI_API signorini_error signorini_problem_set_dense(signorini_problem* problem, int64_t n,
                                                          signorini_order order, const double* M,
                                                          const double* q);

/** The same with a sparse M in compressed columns or rows: the entries of column (row) j are
 * start[j] .. start[j + 1] - 1 of index (their rows or columns, any order, none twice) and value.
 * @param start n + 1 numbers, from 0 to entries, not descending @param n, entries below 2^31 */
SIGNORINI_API signorini_error signorini_problem_set_sparse(signorini_problem* problem, int64_t n,
                                                           signorini_order order, int64_t entries,
                                                           const int32_t* start,
                                                           const int32_t* index,
                                                           const double* value, const double* q);

/** The same with M = J W J^T + diag(c), never formed: J (n x m) in compressed rows, as above; W is
 * block diagonal, its blocks of block_size[k] >= 1 rows (6 for a free rigid body) symmetric
 * positive definite, one after the other in block_value, block_size[k]^2 numbers each; their sizes
 * add up to m. Bodies that nothing moves have no columns; their velocity belongs in q.
 * @param compliance c, n numbers >= 0; null: all 0 */
SIGNORINI_API signorini_error signorini_problem_set_factored(
    signorini_problem* problem, int64_t n, int64_t entries, const int32_t* start,
    const int32_t* index, const double* value, int64_t blocks, const int32_t* block_size,
    signorini_mass_kind kind, const double* block_value, const double* compliance, const double* q);

/** Bounds lower_i <= z_i <= upper_i (-inf and inf allowed; both: a free row, w_i = 0): w_i >= 0 at
 * the lower bound, <= 0 at the upper, 0 in between. Null: all 0, all inf.
 * @param n the problem's rows */
SIGNORINI_API signorini_error signorini_problem_set_bounds(signorini_problem* problem, int64_t n,
                                                           const double* lower,
                                                           const double* upper);

/** Friction limits |z_row| <= coefficient z_normal_row, in place of the bounds of those rows and of
 * the limits set before. coefficient >= 0, dimensionless. */
SIGNORINI_API signorini_error signorini_problem_set_limits(signorini_problem* problem,
                                                           int64_t count, const int32_t* row,
                                                           const int32_t* normal_row,
                                                           const double* coefficient);

/** Friction cones |z_T| <= coefficient z_N over the rows normal_row (N) .. normal_row + dimension -
 * 1 (T), ascending and disjoint, in place of the bounds of those rows and of the cones set before.
 * @param dimension 2 or 3 each */
SIGNORINI_API signorini_error signorini_problem_set_cones(signorini_problem* problem, int64_t count,
                                                          const int32_t* normal_row,
                                                          const int32_t* dimension,
                                                          const double* coefficient,
                                                          signorini_friction_law law);

/** The number of rows. */
SIGNORINI_API int64_t signorini_problem_size(const signorini_problem* problem);
/** q, n numbers, to read or to write before the next solve; valid until the problem is set anew. */
SIGNORINI_API double* signorini_problem_q(signorini_problem* problem);
/** The numbers of M, to read or to write: dense, n^2 by columns; sparse, the entries by columns,
 * rows ascending; factored: null. Valid until the problem is set anew. */
SIGNORINI_API double* signorini_problem_matrix(signorini_problem* problem, int64_t* count);

/* ---- solvers and results -------------------------------------------------------------------- */

typedef struct signorini_solver signorini_solver; /**< settings and workspace */
typedef struct signorini_result signorini_result; /**< what a solve returns */

/** How good z is, recomputed from the caller's data; see lcp/certificate.h for the equations. */
typedef struct signorini_certificate {
  double natural_residual;   /**< max |min(z, w)| / (1 + |q|) */
  double unit_free_residual; /**< max |min(M_ii z_i, w_i)| / |q| */
  double rounding_floor;     /**< what rounding z costs the unit-free residual */
  double natural_floor;      /**< what it costs the natural residual */
  double backward_error;     /**< small where z is exact for slightly other data */
  double min_z;              /**< of the rows with lower bound 0 and the normals of cones */
  double min_w;              /**< of those rows without an upper bound */
  double complementarity;    /**< |z.w| */
  double cone_violation;     /**< max(|z_T| - mu z_N, -z_N, 0); NaN without cones */
  int32_t worst_row;         /**< of the unit-free residual, -1: none */
  int32_t reserved;          /**< 0 */
} signorini_certificate;

/** What a solve cost; -1: the solver has no such thing. */
typedef struct signorini_statistics {
  int64_t iterations;     /**< sweeps or outer iterations */
  int64_t pivots;         /**< exchanges of one basic variable */
  int64_t factorizations; /**< of any matrix, from scratch */
  int64_t refinements;    /**< steps of iterative refinement */
  int64_t factor_bytes;   /**< held by the back-end of a sparse factorisation */
  double solve_seconds;   /**< wall time, certificate included */
} signorini_statistics;

/** One solver's part in a solve that tried several ("auto"). Texts are valid as long as the result.
 */
typedef struct signorini_attempt {
  const char* solver;        /**< its name */
  const char* reason;        /**< why it was tried, one clause */
  const char* detail;        /**< why it ended so; "": nothing to add */
  double natural_residual;   /**< of its iterate */
  double unit_free_residual; /**< of its iterate */
  double solve_seconds;      /**< wall time */
  int64_t iterations;        /**< sweeps or outer iterations, -1: none */
  int64_t pivots;            /**< -1: none */
  signorini_status status;   /**< how it ended */
  int32_t reserved;          /**< 0 */
} signorini_attempt;

/** The solvers' names, null-terminated: "auto", "lemke", "interior-point", ... */
SIGNORINI_API const char* const* signorini_solver_names(void);

/** @param name one of signorini_solver_names() */
SIGNORINI_API signorini_error signorini_solver_create(const char* name, signorini_solver** solver);
/** Null is allowed. */
SIGNORINI_API void signorini_solver_destroy(signorini_solver* solver);

/** Settings by name: "tolerance" (of both residuals, in (0, 1), default 1e-8), "max_iterations"
 * (whole, in the solver's own unit; -1, the default: its own), "time_limit" (s, > 0, default inf),
 * "certify_islands" (0 or 1, default 0), "quick_certificate" (0 or 1, default 0: with it the
 * certificate of a solved factored problem is a bound, at O(n)). A refused value leaves the one
 * before. */
SIGNORINI_API signorini_error signorini_solver_set_number(signorini_solver* solver,
                                                          const char* setting, double value);
/** "dump": DIR[:OPTION[,OPTION]...], where every solve is written as a problem folder that
 * signorini-solve replays (docs/problem-folders.md); "", the default: nowhere. */
SIGNORINI_API signorini_error signorini_solver_set_text(signorini_solver* solver,
                                                        const char* setting, const char* value);

/** A result that is not run. */
SIGNORINI_API signorini_error signorini_result_create(signorini_result** result);
/** Null is allowed. */
SIGNORINI_API void signorini_result_destroy(signorini_result* result);

/** Solves. SIGNORINI_OK says that the solver ran; signorini_result_status() how it ended.
 * SIGNORINI_INVALID_ARGUMENT: among others, a solver that does not take such a problem.
 * @param warm_start null, or one number a row to start from; solvers that cannot use it pass over
 * it
 * @param result written whole; unchanged if the call fails with SIGNORINI_INVALID_ARGUMENT */
SIGNORINI_API signorini_error signorini_solver_solve(signorini_solver* solver,
                                                     const signorini_problem* problem,
                                                     const double* warm_start,
                                                     signorini_result* result);

/** How the solve ended. */
SIGNORINI_API signorini_status signorini_result_status(const signorini_result* result);
/** The solver's name, with the variant that ended the solve: "auto: dantzig". */
SIGNORINI_API const char* signorini_result_solver(const signorini_result* result);
/** Why it ended so and whatever was done beside the plain method, one line; "": nothing to add. */
SIGNORINI_API const char* signorini_result_detail(const signorini_result* result);
/** The number of rows. */
SIGNORINI_API int64_t signorini_result_size(const signorini_result* result);
/** z and w = M z + q, one number a row; like all that follows valid until the result's next solve.
 */
SIGNORINI_API const double* signorini_result_z(const signorini_result* result);
/** See signorini_result_z(). */
SIGNORINI_API const double* signorini_result_w(const signorini_result* result);
/** The ray on which the solve ended, one number a row, or null. */
SIGNORINI_API const double* signorini_result_ray(const signorini_result* result);
/** Every feasible z has |z|_1 >= this; 0: nothing is known. */
SIGNORINI_API double signorini_result_ray_bound(const signorini_result* result);
/** @param bytes sizeof(signorini_certificate), and so on below: that much is written at most */
SIGNORINI_API signorini_error signorini_result_certificate(const signorini_result* result,
                                                           signorini_certificate* certificate,
                                                           size_t bytes);
/** See signorini_result_certificate(). */
SIGNORINI_API signorini_error signorini_result_statistics(const signorini_result* result,
                                                          signorini_statistics* statistics,
                                                          size_t bytes);
/** How many solvers "auto" tried; 0 of other solvers. */
SIGNORINI_API int64_t signorini_result_attempt_count(const signorini_result* result);
/** The attempts in their order. @param number from 0 */
SIGNORINI_API signorini_error signorini_result_attempt(const signorini_result* result,
                                                       int64_t number, signorini_attempt* attempt,
                                                       size_t bytes);
/** With the setting "certify_islands": how many sets of rows nothing connects, else 0; the island
 * of every row (null without); the certificate of each by itself. */
SIGNORINI_API int64_t signorini_result_island_count(const signorini_result* result);
/** The island of every row, from 0; null without "certify_islands". */
SIGNORINI_API const int32_t* signorini_result_island_of_row(const signorini_result* result);
/** The certificate of one island by itself. @param island from 0 */
SIGNORINI_API signorini_error
signorini_result_island_certificate(const signorini_result* result, int64_t island,
                                    signorini_certificate* certificate, size_t bytes);

/* ---- contacts ------------------------------------------------------------------------------- */

/* For a host with its own bodies, collision detection and integrator: in each step, after its
 * forces and before it moves anything, it hands over bodies and contacts and gets the contact
 * impulses and the new velocities. SI units, right-handed, world axes but where body axes are said.
 */

/** What moves a body. */
typedef int32_t signorini_body_kind;
enum {
  SIGNORINI_DYNAMIC = 0,   /**< moved by forces */
  SIGNORINI_KINEMATIC = 1, /**< driven: its velocity is given and no force changes it */
  SIGNORINI_FIXED = 2      /**< never moves; its velocity must be 0 */
};

/** What a friction force is bounded by. */
typedef int32_t signorini_friction_model;
enum {
  SIGNORINI_PYRAMID = 0, /**< pyramid_sides sides inside the cone; the first along the slip */
  SIGNORINI_CONE = 1,    /**< Coulomb's cone, the default */
  SIGNORINI_BOX = 2      /**< both tangents bounded apart */
};

/** Fill it whole; its layout never changes. */
typedef struct signorini_body {
  signorini_body_kind kind; /**< SIGNORINI_DYNAMIC, ... */
  int32_t reserved;         /**< anything */
  double mass;              /**< kg, > 0 (dynamic bodies) */
  double inertia[9];        /**< about the centre of mass, body axes, symmetric, kg m^2 (dynamic) */
  double position[3];       /**< of the centre of mass, m */
  double orientation[4];    /**< unit quaternion w, x, y, z: body axes to world axes */
  double linear_velocity[3];  /**< of the centre of mass, after the step's forces, m/s */
  double angular_velocity[3]; /**< rad/s */
} signorini_body;

/** Fill it whole; its layout never changes. */
typedef struct signorini_contact {
  int32_t body_a;      /**< numbers in the array of bodies, different, one at least dynamic */
  int32_t body_b;      /**< the other */
  double point_a[3];   /**< on the surface of A, m */
  double point_b[3];   /**< on the surface of B, m; point_a - point_b is gap times normal: impulses
                            act in the middle, which is the same only then */
  double normal[3];    /**< unit, from B to A: an impulse f >= 0 pushes A along it, B against it */
  double gap;          /**< normal.(point_a - point_b), m; > 0 apart, < 0 overlapping */
  double friction;     /**< Coulomb's mu of the pair, >= 0 */
  double restitution;  /**< e of the pair, in [0, 1]; acts where gap <= "touching_tolerance" */
  double allowance;    /**< m/s: how fast the gap may close, negative: must open; NaN: max(gap, 0) /
                            step, with restitution e times the approach velocity */
  uint64_t feature_id; /**< the same pair of features has the same id from step to step */
} signorini_contact;

/** What was solved for one island, a set of contacts that no dynamic body connects with others. */
typedef struct signorini_island {
  double unit_free_residual; /**< of its certificate */
  int32_t bodies;            /**< dynamic ones */
  int32_t contacts;          /**< in it */
  int32_t rows;              /**< of its problem */
  signorini_status status;   /**< how its solve ended */
  double residual;           /**< the unit-free one times |q|, m/s: what the dial speaks of */
  double work;               /**< with the dial, in the units of "budget_work"; else 0 */
} signorini_island;

typedef struct signorini_contact_solver signorini_contact_solver; /**< settings and memory */
typedef struct signorini_contact_result signorini_contact_result; /**< what it found */

/** With the default settings. */
SIGNORINI_API signorini_error signorini_contact_solver_create(signorini_contact_solver** solver);
/** Null is allowed. */
SIGNORINI_API void signorini_contact_solver_destroy(signorini_contact_solver* solver);

/** Settings by name: those of signorini_solver_set_number() but "certify_islands"
 * ("quick_certificate" is 1 by default), and "friction_model" (default SIGNORINI_CONE),
 * "pyramid_sides" (even, >= 4, default 8), "warm_start" (0 or 1, default 1: starts from the
 * impulses of the solve before), "touching_tolerance" (m, >= 0, default 1e-6),
 * "restitution_threshold" (m/s, >= 0, default 0: slower contacts do not bounce). With "accuracy"
 * set: "budget_work" (>= 0, default inf: what one solve may cost, shared by the islands; a unit is
 * a thousand rows swept once, a factorisation counts 30 sweeps; the same input gives the same bits)
 * and "budget_seconds" (s, > 0, default inf: wall time). Where a budget runs out the best iterate
 * is the result, its status SIGNORINI_ITERATION_LIMIT or SIGNORINI_TIME_LIMIT. */
SIGNORINI_API signorini_error signorini_contact_solver_set_number(signorini_contact_solver* solver,
                                                                  const char* setting,
                                                                  double value);
/** "solver": one of signorini_solver_names(), default "auto"; "dump" as
 * signorini_solver_set_text(); "accuracy": the dial, one setting for whoever wants no others:
 * "preview", "game", "engineering", "reference" or a residual in m/s (docs/accuracy-dial.md), which
 * chooses Coulomb's cone, the solvers and the tolerance, so that "solver", "friction_model",
 * "tolerance" and "max_iterations" count for nothing; "", the default: off, which a budget
 * forbids. */
SIGNORINI_API signorini_error signorini_contact_solver_set_text(signorini_contact_solver* solver,
                                                                const char* setting,
                                                                const char* value);

/** A result that is not run. */
SIGNORINI_API signorini_error signorini_contact_result_create(signorini_contact_result** result);
/** Null is allowed. */
SIGNORINI_API void signorini_contact_result_destroy(signorini_contact_result* result);

/** Finds all contact impulses at once: M (v+ - v) = J^T f, 0 <= f, J_n v+ + allowance >= 0,
 * complementary, and friction. Where an island is not solved its best iterate is in the result, and
 * the status and detail say so.
 * @param step h, s, > 0 @param result written whole; unchanged with SIGNORINI_INVALID_ARGUMENT */
SIGNORINI_API signorini_error signorini_contact_solver_solve(
    signorini_contact_solver* solver, double step, int64_t body_count, const signorini_body* bodies,
    int64_t contact_count, const signorini_contact* contacts, signorini_contact_result* result);

/** Of the islands the first that is not solved, else solved to rounding if one is. */
SIGNORINI_API signorini_status
signorini_contact_result_status(const signorini_contact_result* result);
/** Whatever was done beside the plain scheme, one line; "": nothing to add. */
SIGNORINI_API const char* signorini_contact_result_detail(const signorini_contact_result* result);
/** The bodies that were handed in. */
SIGNORINI_API int64_t signorini_contact_result_body_count(const signorini_contact_result* result);
/** The contacts that were handed in. */
SIGNORINI_API int64_t
signorini_contact_result_contact_count(const signorini_contact_result* result);
/** v+, 6 numbers a body: linear (of the centre of mass), angular. */
SIGNORINI_API const double* signorini_contact_result_velocities(
    const signorini_contact_result* result);
/** The impulse of every contact on its body A, 3 numbers, N s; on B: minus that. */
SIGNORINI_API const double* signorini_contact_result_impulses(
    const signorini_contact_result* result);
/** f of every contact, N s. */
SIGNORINI_API const double* signorini_contact_result_normal_impulses(
    const signorini_contact_result* result);
/** Change of the kinetic energy by the impulses, J. */
SIGNORINI_API double signorini_contact_result_energy_change(const signorini_contact_result* result);
/** Of the island that ended worst; NaN without contacts. */
SIGNORINI_API signorini_error signorini_contact_result_certificate(
    const signorini_contact_result* result, signorini_certificate* certificate, size_t bytes);
/** Of that island; solve_seconds: of all. */
SIGNORINI_API signorini_error signorini_contact_result_statistics(
    const signorini_contact_result* result, signorini_statistics* statistics, size_t bytes);
/** The position of the dial: "game", "1e-06 m/s"; "": it was not used. */
SIGNORINI_API const char* signorini_contact_result_accuracy(const signorini_contact_result* result);
/** What was spent, in the units of "budget_work"; 0 without the dial. */
SIGNORINI_API double signorini_contact_result_work(const signorini_contact_result* result);
/** 0 where a clock ("budget_seconds", "time_limit") decides when a solver stops, else 1: the same
 * input then gives the same bits. */
SIGNORINI_API int signorini_contact_result_is_deterministic(const signorini_contact_result* result);
/** Into how many islands the contacts fell. */
SIGNORINI_API int64_t signorini_contact_result_island_count(const signorini_contact_result* result);
/** The island of every contact. */
SIGNORINI_API const int32_t* signorini_contact_result_island_of_contact(
    const signorini_contact_result* result);
/** What was solved for an island. @param number from 0 */
SIGNORINI_API signorini_error signorini_contact_result_island(
    const signorini_contact_result* result, int64_t number, signorini_island* island, size_t bytes);

#ifdef __cplusplus
}
#endif

#endif
