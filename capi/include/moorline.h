/* moorline as a library for C. Written by cbindgen: do not edit.
 *
 * A handle is null or came from moorline_load or moorline_read; one that was closed is refused. Any thread may call; calls on one
 * simulation wait for one another. Functions that return int return MOORLINE_OK or another code, with a sentence for moorline_message.
 * SI units and radians throughout; z is up, and forces are those that the mooring applies.
 */

#ifndef MOORLINE_H
#define MOORLINE_H

#include <stddef.h>
#include <stdint.h>

// Version of this interface, which a host passes to load and read; it changes with every incompatible change.
#define MOORLINE_ABI_VERSION 1

// The call succeeded.
#define MOORLINE_OK 0

// A handle is null, closed or unknown.
#define MOORLINE_INVALID_HANDLE 1

// An argument is null, of a wrong length, or has a value that cannot be used.
#define MOORLINE_INVALID_ARGUMENT 2

// The host was built for another version of this interface.
#define MOORLINE_WRONG_VERSION 3

// The scene or deck cannot be read, or contains mistakes.
#define MOORLINE_SCENE_ERROR 4

// No static equilibrium was found.
#define MOORLINE_STATICS_ERROR 5

// A step failed; the state is unchanged.
#define MOORLINE_STEP_ERROR 6

// The call is not allowed in this phase: before or after start.
#define MOORLINE_WRONG_PHASE 7

// moorline does not compute this result for the scene.
#define MOORLINE_NOT_AVAILABLE 8

// Internal fault of the library: the simulation can only be closed.
#define MOORLINE_INTERNAL_ERROR 9

// Causality of a variable: the host sets it before a step.
#define MOORLINE_INPUT 0

// Causality of a variable: the host reads it.
#define MOORLINE_OUTPUT 1

// Causality of a variable: the host may set it before start.
#define MOORLINE_PARAMETER 2

// Causality of a variable: it follows from the parameters at start.
#define MOORLINE_CALCULATED_PARAMETER 3

// Target of [`moorline_simulation`].
typedef struct MoorlineSimulationTarget MoorlineSimulationTarget;

// Handle of a simulation.
typedef struct MoorlineSimulationTarget *moorline_simulation;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Gets the number of bodies that the host moves: coupled points, then vessels.
int moorline_body_count(moorline_simulation simulation, size_t *count);

// Gets the name of a body, counted from 0. The text is returned as by `moorline_message`.
int moorline_body_name(moorline_simulation simulation, size_t body, char *text, size_t room, size_t *needed);

// Gets the number of degrees of freedom of a body: 3 for a point, 6 for a vessel.
int moorline_body_size(moorline_simulation simulation, size_t body, size_t *size);

// Sets the displacement of a body from its reference position [m] and, for a vessel, roll, pitch and yaw relative to its reference attitude
// [rad] (body to global by yaw, pitch, roll, Z-Y-X); and its velocity [m/s] and angular velocity in global axes [rad/s], which are derived if
// `velocity` is null.
int moorline_move(moorline_simulation simulation,
                  size_t body,
                  const double *place,
                  const double *velocity,
                  size_t size);

// Gets the force of the mooring on a body [N] and, for a vessel, the moment about the vessel's origin [N m], in global axes.
int moorline_force(moorline_simulation simulation, size_t body, double *force, size_t size);

// Gets the 36 values of the current stiffness of the mooring on a vessel, row by row: force [N/m, N] and moment [N, N m].
int moorline_stiffness(moorline_simulation simulation, size_t body, double *stiffness, size_t count);

// Gets the number of lines.
int moorline_line_count(moorline_simulation simulation, size_t *count);

// Gets the name of a line, counted from 0. The text is returned as by `moorline_message`.
int moorline_line_name(moorline_simulation simulation, size_t line, char *text, size_t room, size_t *needed);

// Gets the number of nodes of a line; only after start.
int moorline_node_count(moorline_simulation simulation, size_t line, size_t *count);

// Gets x, y, z of every node of a line, from end A to end B [m]: three values per node.
int moorline_node_positions(moorline_simulation simulation, size_t line, double *positions, size_t count);

// Gets the effective tension at every node of a line, from end A to end B [N].
int moorline_node_tensions(moorline_simulation simulation, size_t line, double *tensions, size_t count);

// Gets x, y, z of the positions at which the water flow is required next, for the nodes of a line from end A to end B [m]: three values per
// node. These are the current positions of the nodes or, if inputs refer to the end of the step, their expected positions there. Only after start.
int moorline_flow_places(moorline_simulation simulation,
                         size_t line,
                         double *places,
                         size_t count);

// Sets velocity [m/s] and acceleration [m/s2] of the water at those positions, three values per node, in a scene with `flow = "host"` in [water].
int moorline_set_flow(moorline_simulation simulation,
                      size_t line,
                      const double *velocities,
                      const double *accelerations,
                      size_t count);

// Returns the version of this interface: MOORLINE_ABI_VERSION of the header with which the library was built.
uint32_t moorline_abi_version(void);

// Gets the message of the last call that failed on this thread. A text is copied with a zero byte into `room` bytes and truncated to fit; `needed`,
// unless null, receives the size needed for the whole text. With room 0, `text` may be null.
int moorline_message(char *text,
                     size_t room,
                     size_t *needed);

// Loads a scene, or a deck of MoorDyn or MAP++, from a file. `abi_version` is MOORLINE_ABI_VERSION.
int moorline_load(uint32_t abi_version, const char *path, moorline_simulation *simulation);

// Reads a scene from a TOML text that refers to no other files.
int moorline_read(uint32_t abi_version, const char *toml, moorline_simulation *simulation);

// Closes a simulation; its handle becomes invalid. Null is ignored.
int moorline_close(moorline_simulation simulation);

// Selects by convergence trials the values that the scene leaves open: elements, integrator and time step. Takes up to seconds; otherwise, rules choose
// them. Only before start. Find the variables of profiles and flow after it, and set the flow for the nodes of the selected mesh.
int moorline_select(moorline_simulation simulation);

// Starts at a time [s], in the scene's initial shapes (static equilibrium by default) with the current inputs.
int moorline_start(moorline_simulation simulation, double time);

// Returns to the state before start; parameters and inputs are kept.
int moorline_reset(moorline_simulation simulation);

// Steps by a time [s]. Inputs refer to the start of the step, or to its end if the scene specifies that.
int moorline_step(moorline_simulation simulation, double step);

// Gets the warnings on the scene, the start and the steps that have not been read yet, one per line; an empty text if there are none. A text that
// does not fit into `room` is kept for the next call.
int moorline_warnings(moorline_simulation simulation,
                      char *text,
                      size_t room,
                      size_t *needed);

// Gets the time [s].
int moorline_time(moorline_simulation simulation, double *time);

// Gets the state as bytes. `needed`, unless null, receives their number; with room 0, `bytes` may be null.
int moorline_save(moorline_simulation simulation, uint8_t *bytes, size_t room, size_t *needed);

// Restores a state of `moorline_save`; the simulation continues bit for bit. The state may come from another simulation of the same scene.
int moorline_restore(moorline_simulation simulation, const uint8_t *bytes, size_t count);

// Gets the static equilibrium of the scene at its reference positions as JSON, as `moorline statics --json`. The text is returned as by `moorline_message`.
int moorline_statics(moorline_simulation simulation,
                     char *text,
                     size_t room,
                     size_t *needed);

// Gets the scene with its current parameters as TOML. The text is returned as by `moorline_message`.
int moorline_scene(moorline_simulation simulation, char *text, size_t room, size_t *needed);

// Gets the number of variables, which is also the greatest reference; references count from 1.
int moorline_variable_count(moorline_simulation simulation, size_t *count);

// Gets the reference of a variable by its name, for example `fairlead.x`.
int moorline_find(moorline_simulation simulation, const char *name, uint32_t *reference);

// Gets the name of a variable. The text is returned as by `moorline_message`.
int moorline_variable_name(moorline_simulation simulation, uint32_t reference, char *text, size_t room, size_t *needed);

// Gets the unit of a variable. The text is returned as by `moorline_message`.
int moorline_variable_unit(moorline_simulation simulation, uint32_t reference, char *text, size_t room, size_t *needed);

// Gets the description of a variable, one sentence. The text is returned as by `moorline_message`.
int moorline_variable_description(moorline_simulation simulation, uint32_t reference, char *text, size_t room, size_t *needed);

// Gets the causality of a variable: MOORLINE_INPUT, MOORLINE_OUTPUT, MOORLINE_PARAMETER or MOORLINE_CALCULATED_PARAMETER.
int moorline_variable_causality(moorline_simulation simulation, uint32_t reference, int *causality);

// Sets inputs, and before start parameters: all of them, or none if one is refused. Displacements are relative to the reference positions [m, rad].
int moorline_set(moorline_simulation simulation,
                 const uint32_t *references,
                 const double *values,
                 size_t count);

// Gets the values of variables. Results are available after start.
int moorline_get(moorline_simulation simulation, const uint32_t *references, double *values, size_t count);

// Gets the derivatives of `count` outputs with respect to an input, a displacement or a velocity, at the end of the last step. Requires
// `derivatives = true` in `[output]` of the scene.
int moorline_derivatives(moorline_simulation simulation, const uint32_t *outputs, double *values, size_t count, uint32_t input);

// Gets the time derivatives of `count` outputs [per second] at the end of the last step. Requires `derivatives = true` in `[output]` of the scene.
int moorline_rates(moorline_simulation simulation,
                   const uint32_t *outputs,
                   double *values,
                   size_t count);

// Gets the number of inputs.
int moorline_input_count(moorline_simulation simulation, size_t *count);

// Gets the number of outputs.
int moorline_output_count(moorline_simulation simulation, size_t *count);

// Gets the number of parameters.
int moorline_parameter_count(moorline_simulation simulation, size_t *count);

// Sets all inputs, in the order of their references.
int moorline_set_inputs(moorline_simulation simulation, const double *values, size_t count);

// Gets all outputs, in the order of their references.
int moorline_get_outputs(moorline_simulation simulation, double *values, size_t count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MOORLINE_H */
