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

// Version of this interface, which a host gives to load and read; it changes with every change that breaks a host.
#define MOORLINE_ABI_VERSION 1

// The call succeeded.
#define MOORLINE_OK 0

// A handle is null, closed, or none.
#define MOORLINE_INVALID_HANDLE 1

// An argument is null, of a wrong length, or has a value that cannot be used.
#define MOORLINE_INVALID_ARGUMENT 2

// The host was built for another version of this interface.
#define MOORLINE_WRONG_VERSION 3

// The scene or deck cannot be read, or has mistakes.
#define MOORLINE_SCENE_ERROR 4

// There is no static equilibrium.
#define MOORLINE_STATICS_ERROR 5

// A step failed; the state is that before it.
#define MOORLINE_STEP_ERROR 6

// The call comes too early or too late: before or after start.
#define MOORLINE_WRONG_PHASE 7

// moorline does not find it for this scene.
#define MOORLINE_NOT_AVAILABLE 8

// A fault inside the library: the simulation serves nothing but close any more.
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

// Gives the number of bodies that the host moves: coupled points, then vessels.
int moorline_body_count(moorline_simulation simulation, size_t *count);

// Gives the name of a body, counted from 0. `moorline_message` says how a text is given.
int moorline_body_name(moorline_simulation simulation, size_t body, char *text, size_t room, size_t *needed);

// Gives the degrees of freedom of a body: 3 of a point, 6 of a vessel.
int moorline_body_size(moorline_simulation simulation, size_t body, size_t *size);

// Sets the displacement of a body from its reference [m], with roll, pitch and yaw of a vessel added to those of its reference attitude [rad], body to
// global by yaw, pitch, roll (Z-Y-X); and its velocity [m/s] and angular velocity in global axes [rad/s], which are derived where `velocity` is null.
int moorline_move(moorline_simulation simulation,
                  size_t body,
                  const double *place,
                  const double *velocity,
                  size_t size);

// Gives the force of the mooring on a body [N] and, on a vessel, its moment about the vessel's origin [N m], in global axes.
int moorline_force(moorline_simulation simulation, size_t body, double *force, size_t size);

// Gives the 36 values of the stiffness of the mooring on a vessel as it is now, by rows of force [N/m, N] and moment [N, N m].
int moorline_stiffness(moorline_simulation simulation, size_t body, double *stiffness, size_t count);

// Gives the number of lines.
int moorline_line_count(moorline_simulation simulation, size_t *count);

// Gives the name of a line, counted from 0. `moorline_message` says how a text is given.
int moorline_line_name(moorline_simulation simulation, size_t line, char *text, size_t room, size_t *needed);

// Gives the number of nodes of a line, from start on.
int moorline_node_count(moorline_simulation simulation, size_t line, size_t *count);

// Gives x, y, z of every node of a line, from end A to end B [m]: three values a node.
int moorline_node_positions(moorline_simulation simulation, size_t line, double *positions, size_t count);

// Gives the effective tension at every node of a line, from end A to end B [N].
int moorline_node_tensions(moorline_simulation simulation, size_t line, double *tensions, size_t count);

// Gives x, y, z of the places for which the flow of the water is due next, for the nodes of a line from end A to end B [m]: three values a node. These
// are the places of the nodes now or, where inputs hold for the end of the step, the places they are expected to reach. From start on.
int moorline_flow_places(moorline_simulation simulation,
                         size_t line,
                         double *places,
                         size_t count);

// Sets the velocity [m/s] and the acceleration [m/s2] of the water at those places, three values a node, in a scene with `flow = "host"` in [water].
int moorline_set_flow(moorline_simulation simulation,
                      size_t line,
                      const double *velocities,
                      const double *accelerations,
                      size_t count);

// Returns the version of this interface; it is MOORLINE_ABI_VERSION of the header that the library was built with.
uint32_t moorline_abi_version(void);

// Gives the message of the last call of this thread that failed. A text is written with a zero byte into `room` bytes and cut to them; `needed`,
// unless it is null, becomes the room of the whole text. With room 0, `text` may be null.
int moorline_message(char *text,
                     size_t room,
                     size_t *needed);

// Loads a scene, or a deck of MoorDyn or MAP++, from a file. `abi_version` is MOORLINE_ABI_VERSION.
int moorline_load(uint32_t abi_version, const char *path, moorline_simulation *simulation);

// Reads a scene from a text in TOML, which names no other files.
int moorline_read(uint32_t abi_version, const char *toml, moorline_simulation *simulation);

// Closes a simulation; its handle is refused from then on. Null is nothing to close.
int moorline_close(moorline_simulation simulation);

// Selects by trials what the scene leaves open: elements, integrator and time step. Takes up to seconds; without it, rules choose. Before start.
int moorline_select(moorline_simulation simulation);

// Starts at a time [s], in the scene's initial shapes (static equilibrium by default) at the present inputs.
int moorline_start(moorline_simulation simulation, double time);

// Goes back to before start; parameters and inputs stay.
int moorline_reset(moorline_simulation simulation);

// Steps by a time [s]. Inputs hold for the start of the step, or for its end where the scene says so.
int moorline_step(moorline_simulation simulation, double step);

// Gives the warnings on the scene, the start and the steps that were not given before, a line each; an empty text where there are none. A text that
// does not fit into `room` is given again.
int moorline_warnings(moorline_simulation simulation,
                      char *text,
                      size_t room,
                      size_t *needed);

// Gives the time [s].
int moorline_time(moorline_simulation simulation, double *time);

// Gives the state as bytes. `needed`, unless it is null, becomes their number; with room 0, `bytes` may be null.
int moorline_save(moorline_simulation simulation, uint8_t *bytes, size_t room, size_t *needed);

// Goes back to a state of `moorline_save`, from which it goes on bit for bit. A state may be that of another simulation of the same scene.
int moorline_restore(moorline_simulation simulation, const uint8_t *bytes, size_t count);

// Gives the static equilibrium of the scene at its reference positions as JSON, as `moorline statics --json` does. `moorline_message` says how a text is given.
int moorline_statics(moorline_simulation simulation,
                     char *text,
                     size_t room,
                     size_t *needed);

// Gives the scene with its present parameters as TOML. `moorline_message` says how a text is given.
int moorline_scene(moorline_simulation simulation, char *text, size_t room, size_t *needed);

// Gives the number of variables; their references are 1 to this number.
int moorline_variable_count(moorline_simulation simulation, size_t *count);

// Gives the reference of a variable by its name, such as `fairlead.x`.
int moorline_find(moorline_simulation simulation, const char *name, uint32_t *reference);

// Gives the name of a variable. `moorline_message` says how a text is given.
int moorline_variable_name(moorline_simulation simulation, uint32_t reference, char *text, size_t room, size_t *needed);

// Gives the unit of a variable. `moorline_message` says how a text is given.
int moorline_variable_unit(moorline_simulation simulation, uint32_t reference, char *text, size_t room, size_t *needed);

// Gives the description of a variable in a sentence. `moorline_message` says how a text is given.
int moorline_variable_description(moorline_simulation simulation, uint32_t reference, char *text, size_t room, size_t *needed);

// Gives the causality of a variable: MOORLINE_INPUT, MOORLINE_OUTPUT, MOORLINE_PARAMETER or MOORLINE_CALCULATED_PARAMETER.
int moorline_variable_causality(moorline_simulation simulation, uint32_t reference, int *causality);

// Sets inputs, and parameters before start: all of them or, where one is refused, none. Displacements are from the reference positions [m, rad].
int moorline_set(moorline_simulation simulation,
                 const uint32_t *references,
                 const double *values,
                 size_t count);

// Gets variables. Results have values from start on.
int moorline_get(moorline_simulation simulation, const uint32_t *references, double *values, size_t count);

// Gives the derivatives of `count` outputs by an input, a displacement or a velocity, at the end of the last step. The scene asks for them with
// `derivatives = true` in `[output]`.
int moorline_derivatives(moorline_simulation simulation,
                         const uint32_t *outputs,
                         double *values,
                         size_t count,
                         uint32_t input);

// Gives the rates of `count` outputs in time, per second, at the end of the last step. The scene asks for them with `derivatives = true` in
// `[output]`.
int moorline_rates(moorline_simulation simulation, const uint32_t *outputs, double *values, size_t count);

// Gives the number of inputs.
int moorline_input_count(moorline_simulation simulation, size_t *count);

// Gives the number of outputs.
int moorline_output_count(moorline_simulation simulation, size_t *count);

// Gives the number of parameters.
int moorline_parameter_count(moorline_simulation simulation, size_t *count);

// Sets all inputs, in the order of their references.
int moorline_set_inputs(moorline_simulation simulation, const double *values, size_t count);

// Gets all outputs, in the order of their references.
int moorline_get_outputs(moorline_simulation simulation, double *values, size_t count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MOORLINE_H */
