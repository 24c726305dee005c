/* The interface between a compiled integrator and who runs it: plain C, versioned.
 *
 * A plugin exports one function, hamgen_plugin_entry, that returns a table of functions.  A value
 * crosses the interface as hi + lo, where hi is the double nearest to it; lo is 0 unless the scalar
 * is wider.  `lo` pointers may be null but get_carry's.  Arrays are contiguous: state = q1..qn,
 * p1..pn (2n values), in the order of variable_list; a pointer to no values at all may be null.
 *
 * hamgen_plugin_entry returns null where hamgen_arithmetic_is_ieee() is 0: the plugin then was
 * compiled with flags, such as -ffast-math, under which its methods are not what they claim. */
#ifndef HAMGEN_PLUGIN_H
#define HAMGEN_PLUGIN_H

#define HAMGEN_PLUGIN_VERSION 5

#ifdef __cplusplus
extern "C" {
#endif

enum hamgen_status {
  HAMGEN_DONE = 0,
  HAMGEN_NOT_CONVERGED =
      1,                 /* the implicit step found no solution; the state is the last good one */
  HAMGEN_NOT_FINITE = 2, /* the step left the domain of H or overflowed; same, unless the state is
                          * not finite: steps of a polynomial H are not looked at one by one */
  HAMGEN_STOPPED = 3     /* the host asked to stop */
};

struct hamgen_report {
  int status;            /* hamgen_status */
  long long steps_done;  /* of this call */
  long long iterations;  /* summed over the steps done */
  int last_iterations;   /* of the step that failed, or the last one */
  double last_increment; /* size of the last increment of that step's iteration */
  double energy_min;     /* over the states after each step, if energy was watched */
  double energy_min_lo;
  double energy_max;
  double energy_max_lo;
  double energy_last;
  double energy_last_lo;
};

/* A running integration: state, compensation, start values. Opaque. */
struct hamgen_run;

/* A variable, a parameter or an invariant of the model, or an array of them. */
struct hamgen_quantity {
  const char* name; /* "eps", or "m" of an array, whose elements are m[first], m[first + 1], ... */
  const char* unit; /* as the model has it, "" if it has none */
  const char* comment; /* likewise */
  int is_array;
  int first; /* subscript of the first element; 0 if it is no array */
  int count; /* of its values; 1 if it is no array */
};

struct hamgen_plugin {
  int version; /* HAMGEN_PLUGIN_VERSION */
  int degrees_of_freedom;
  int parameter_count; /* run-time parameters in use, E0 (if any) last */
  int invariant_count;
  int scalar_digits;       /* binary digits of Real: 24, 53, 64, 113 */
  const char* description; /* "pendulum, implicit-midpoint" */
  const char* solver;      /* "newton 1", "explicit", ... for the summary */

  /* parameters: parameter_count values; state: 2n values.  Null if memory is short. */
  struct hamgen_run* (*create)(const double* parameters, const double* parameters_lo, double h,
                               double h_lo, const double* state, const double* state_lo);
  void (*destroy)(struct hamgen_run* run);
  /* Advances by `steps` steps, fewer on failure. With watch_energy, H after every step enters
   * energy_min and energy_max; a step after which H is not finite is the last of the call, counted,
   * and HAMGEN_NOT_FINITE.  Else the state stays the last good one on failure. */
  void (*advance)(struct hamgen_run* run, long long steps, int watch_energy,
                  struct hamgen_report* report);
  void (*get_state)(const struct hamgen_run* run, double* state, double* state_lo);
  /* What rounding took from the state: state + state_lo + carry + carry_lo, exactly, is what the
   * next step starts from. */
  void (*get_carry)(const struct hamgen_run* run, double* carry, double* carry_lo);
  /* The hi of H. */
  double (*energy)(const double* parameters, const double* parameters_lo, const double* state,
                   const double* state_lo, double* energy_lo);
  /* invariant_count values */
  void (*invariants)(const double* parameters, const double* parameters_lo, const double* state,
                     const double* state_lo, double* values, double* values_lo);
  /* grad H at doubles, rounded to double: 2n values, H_q first. */
  void (*gradient)(const double* parameters, const double* state, double* gradient);
  /* One step from `state` to `new_state` and its linearisation there: matrix[i * 2n + j] is
   * d(new_state_i)/d(state_j).  0 if there is no step.  Null in a plugin made without it. */
  int (*tangent)(const double* parameters, double h, const double* state, double* new_state,
                 double* matrix);
  /* All that a run is: state, carry, what is known from earlier steps.  Returns the number of bytes
   * and writes them if `bytes` is not null; 0 if the run is more than its bytes. */
  long long (*save)(const struct hamgen_run* run, void* bytes);
  /* Makes the run what it was when these were written, by the same plugin, so that what it does
   * next is the same to the last bit; 0 if the number of bytes is another. */
  int (*restore)(struct hamgen_run* run, const void* bytes, long long size);

  /* What follows is null in a table that is not of an emitted plugin.
   *
   * What the values of a state, the parameters and the invariants are, in this order; each list
   * ends with a quantity whose name is null. */
  const struct hamgen_quantity* variable_list;
  const struct hamgen_quantity* parameter_list;
  const struct hamgen_quantity* invariant_list;
  /* The parameters as the model declares them: parameter_count values. */
  void (*default_parameters)(double* parameters, double* parameters_lo);
  /* Time since t = 0 of `create`, or since what set_state said; a time of the model's own begins
   * where its state does. */
  double (*get_time)(const struct hamgen_run* run, double* t_lo);
  double (*get_h)(const struct hamgen_run* run, double* h_lo);
  void (*get_parameters)(const struct hamgen_run* run, double* parameters, double* parameters_lo);
  /* The run goes on from this state at time t, as a new one would. */
  void (*set_state)(struct hamgen_run* run, double t, double t_lo, const double* state,
                    const double* state_lo);
  /* The run goes on from its time and state with another step, or with other parameters; what
   * rounding took from the state is forgotten. */
  void (*set_h)(struct hamgen_run* run, double h, double h_lo);
  void (*set_parameters)(struct hamgen_run* run, const double* parameters,
                         const double* parameters_lo);
};

typedef const struct hamgen_plugin* (*hamgen_plugin_entry_type)(void);

/* 1 if, where this is compiled, a sum is not reordered, a quotient is not a product with a
 * reciprocal, zero has its sign and NaN is not equal to itself.  The operands are volatile: to the
 * compiler they could be anything. */
static inline int hamgen_arithmetic_is_ieee(void) {
  const volatile double operands[6] = {1.0, 1e-18, 49.0, 98.0, -0.0, __builtin_nan("")};
  const double a = operands[0], b = operands[1], y = operands[2], minus_zero = operands[4];
  const double nan = operands[5];
  /* a + b = 1, and what rounding lost of it is b. */
  const double sum = a + b, part = sum - a;
  const double lost = (a - (sum - part)) + (b - part);
  /* 49*(1/49) is not 1. */
  const double one = operands[2] / y, two = operands[3] / y;
  return lost == b && one == 1.0 && two == 2.0 && !__builtin_signbit(minus_zero + 0.0) &&
         nan != nan;
}

#ifdef __cplusplus
}
#endif
#endif
