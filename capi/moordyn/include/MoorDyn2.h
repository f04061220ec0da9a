/* C interface of MoorDyn as moorline provides it. Written by cbindgen: do not edit.
 *
 * A handle is null or came from a function here; one that was closed is refused. Any thread may call; calls on one system wait for one another.
 * Functions that return int return 0 or a code below 0, and write a sentence to the log of the system. Lines, points, rods, bodies count from 1
 * in the deck's order, nodes and attachments from 0. SI units and radians throughout.
 */

#ifndef MOORLINE_MOORDYN2_H
#define MOORLINE_MOORDYN2_H

#include <stddef.h>
#include <stdint.h>

// The call succeeded.
#define MOORDYN_SUCCESS 0

// The deck cannot be used.
#define MOORDYN_INVALID_INPUT_FILE -1

// A file cannot be written.
#define MOORDYN_INVALID_OUTPUT_FILE -2

// An argument is of the wrong kind.
#define MOORDYN_INVALID_INPUT -3

// The computation did not stay finite.
#define MOORDYN_NAN_ERROR -4

// Memory cannot be allocated.
#define MOORDYN_MEM_ERROR -5

// An argument has a value that cannot be used, such as null.
#define MOORDYN_INVALID_VALUE -6

// moorline does not model the requested feature.
#define MOORDYN_NOT_IMPLEMENTED -7

// Any other error.
#define MOORDYN_UNHANDLED_ERROR -255

// Level that disables all messages.
#define MOORDYN_NO_OUTPUT 4096

// Level of errors.
#define MOORDYN_ERR_LEVEL 3

// Level of warnings.
#define MOORDYN_WRN_LEVEL 2

// Level of messages.
#define MOORDYN_MSG_LEVEL 1

// Level of details.
#define MOORDYN_DBG_LEVEL 0

// Target of [`MoorDynBody`].
typedef struct MoorDynBodyTarget MoorDynBodyTarget;

// Target of [`MoorDynLine`].
typedef struct MoorDynLineTarget MoorDynLineTarget;

// Target of [`MoorDynPoint`].
typedef struct MoorDynPointTarget MoorDynPointTarget;

// Target of [`MoorDynRod`].
typedef struct MoorDynRodTarget MoorDynRodTarget;

// Target of [`MoorDynSeafloor`].
typedef struct MoorDynSeafloorTarget MoorDynSeafloorTarget;

// Target of [`MoorDyn`].
typedef struct MoorDynSystemTarget MoorDynSystemTarget;

// Target of [`MoorDynWaves`].
typedef struct MoorDynWavesTarget MoorDynWavesTarget;

// Handle of a line.
typedef struct MoorDynLineTarget *MoorDynLine;

// Handle of a body.
typedef struct MoorDynBodyTarget *MoorDynBody;

// Handle of a point.
typedef struct MoorDynPointTarget *MoorDynPoint;

// Handle of a rod.
typedef struct MoorDynRodTarget *MoorDynRod;

// Handle of a system.
typedef struct MoorDynSystemTarget *MoorDyn;

// Handle of the water of a system.
typedef struct MoorDynWavesTarget *MoorDynWaves;

// Handle of the seabed of a system.
typedef struct MoorDynSeafloorTarget *MoorDynSeafloor;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Creates and starts the system of the first interface; it replaces an earlier one.
int MoorDynInit(const double *x, const double *xd, const char *infilename);

// Steps the system as `MoorDyn_Step`.
int MoorDynStep(const double *x, const double *xd, double *f, double *t, double *dt);

// Closes the system.
int MoorDynClose(void);

// Turns messages in the console on, or off if `disable` is not 0; also applies to systems created later.
void SetDisableConsole(int disable);

// Returns the tension of the last segment [N] of a line by its number, from 1; NaN if there is none.
double GetFairTen(int l);

// Gets the tensions of the first `*numLines` lines [N] as `MoorDyn_GetFASTtens` does.
int GetFASTtens(const int *numLines, float *FairHTen, float *FairVTen, float *AnchHTen, float *AnchVTen);

// Gets the position of a point [m] by its number, from 1.
int GetPointPos(int l, double *pos);

// Gets the force on a point [N] by its number, from 1.
int GetPointForce(int l, double *force);

// Gets the position [m] of a node, counted from 0, of a line, counted from 1.
int GetNodePos(int LineNum, int NodeNum, double *pos);

// Not supported: moorline does not model water kinematics from the host.
int externalWaveKinInit(void);

// Not supported, as `externalWaveKinInit`; writes an error to the log.
void getWaveKinCoordinates(double *_r);

// Not supported, as `externalWaveKinInit`; writes an error to the log.
void setWaveKin(const double *_U, const double *_Ud, double _t);

// Does nothing: `MoorDynStep` writes the output channels to their files.
void AllOutput(double _t, double _dt);

// Gets the number of a line, as in the deck.
int MoorDyn_GetLineID(MoorDynLine l, int *id);

// Gets the number of segments of a line.
int MoorDyn_GetLineN(MoorDynLine l, unsigned int *n);

// Gets the number of nodes of a line.
int MoorDyn_GetLineNumberNodes(MoorDynLine l, unsigned int *n);

// Gets the unstretched length of a line [m].
int MoorDyn_GetLineUnstretchedLength(MoorDynLine l, double *ul);

// Sets the unstretched length of a line [m]; only before the start.
int MoorDyn_SetLineUnstretchedLength(MoorDynLine l, double ul);

// Refuses a rate of the unstretched length [m/s] other than 0.
int MoorDyn_SetLineUnstretchedLengthVel(MoorDynLine l, double v);

// Gets 1 if a line has a constant axial stiffness, otherwise 0.
int MoorDyn_IsLineConstantEA(MoorDynLine l, int *b);

// Gets the axial stiffness of a line [N].
int MoorDyn_GetLineConstantEA(MoorDynLine l, double *EA);

// Sets the axial stiffness of a line [N]; only before the start.
int MoorDyn_SetLineConstantEA(MoorDynLine l, double EA);

// Gets 0: bending by internal pressure is not modelled.
int MoorDyn_IsLinePressBend(MoorDynLine l, int *b);

// Refuses to enable bending by internal pressure, which is not modelled.
int MoorDyn_SetLinePressBend(MoorDynLine l, int b);

// Not supported: bending by internal pressure is not modelled.
int MoorDyn_SetLinePressInt(MoorDynLine l, const double *_p);

// Gets the position [m] at node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodePos(MoorDynLine l, unsigned int i, double *out);

// Gets the velocity [m/s] at node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodeVel(MoorDynLine l, unsigned int i, double *out);

// Gets the sum of all forces except inertia [N] on node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodeForce(MoorDynLine l, unsigned int i, double *out);

// Gets the tension [N] at node `i` of a line, counted from 0 at end A, as a vector towards end B.
int MoorDyn_GetLineNodeTen(MoorDynLine l, unsigned int i, double *out);

// Gets the bending force [N] on node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodeBendStiff(MoorDynLine l, unsigned int i, double *out);

// Gets the weight less buoyancy [N] of node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodeWeight(MoorDynLine l, unsigned int i, double *out);

// Gets the drag force [N] on node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodeDrag(MoorDynLine l, unsigned int i, double *out);

// Gets the force of the accelerated water [N] on node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodeFroudeKrilov(MoorDynLine l, unsigned int i, double *out);

// Gets the seabed force [N] on node `i` of a line, counted from 0 at end A.
int MoorDyn_GetLineNodeSeabedForce(MoorDynLine l, unsigned int i, double *out);

// Gets the curvature of a line at a node [1/m]; 0 without bending stiffness.
int MoorDyn_GetLineNodeCurv(MoorDynLine l, unsigned int i, double *curv);

// Gets the mass matrix of a node of a line, added mass included, row by row [kg].
int MoorDyn_GetLineNodeM(MoorDynLine l, unsigned int i, double (*m)[3]);

// Gets the tension of the last segment of a line at end B [N].
int MoorDyn_GetLineFairTen(MoorDynLine l, double *t);

// Gets the greatest nodal tension of a line [N].
int MoorDyn_GetLineMaxTen(MoorDynLine l, double *t);

// Writes the shape of a line for ParaView.
int MoorDyn_SaveLineVTK(MoorDynLine l, const char *filename);

// Gets the number of a body, as in the deck.
int MoorDyn_GetBodyID(MoorDynBody b, int *id);

// Gets the kind of a body: -1 coupled, 0 free, 1 fixed.
int MoorDyn_GetBodyType(MoorDynBody b, int *t);

// Gets the position [m] and angles [rad] of a body, and its velocity [m/s] and angular velocity [rad/s].
int MoorDyn_GetBodyState(MoorDynBody b, double *r, double *rd);

// Gets the position of a body [m].
int MoorDyn_GetBodyPos(MoorDynBody b, double *out);

// Gets roll, pitch and yaw of a body [rad], for the rotation Rx Ry Rz.
int MoorDyn_GetBodyAngle(MoorDynBody b, double *out);

// Gets the velocity of a body [m/s].
int MoorDyn_GetBodyVel(MoorDynBody b, double *out);

// Gets the angular velocity of a body [rad/s].
int MoorDyn_GetBodyAngVel(MoorDynBody b, double *out);

// Gets the force [N] and moment [N m] of the lines on a coupled body, about its reference point.
int MoorDyn_GetBodyForce(MoorDynBody b, double *f);

// Gets the mass matrix of the end nodes on a coupled body, added mass included, row by row [kg, kg m, kg m²].
int MoorDyn_GetBodyM(MoorDynBody b, double (*m)[6]);

// Not supported: a body has no geometry.
int MoorDyn_SaveBodyVTK(MoorDynBody b, const char *_filename);

// Gets the number of a point, as in the deck.
int MoorDyn_GetPointID(MoorDynPoint point, int *id);

// Gets the kind of a point: -1 coupled, 0 free, 1 fixed or on a body.
int MoorDyn_GetPointType(MoorDynPoint point, int *t);

// Gets the position of a point [m].
int MoorDyn_GetPointPos(MoorDynPoint point, double *out);

// Gets the velocity of a point [m/s].
int MoorDyn_GetPointVel(MoorDynPoint point, double *out);

// Gets the force on a point [N]: from its lines and from its own loads.
int MoorDyn_GetPointForce(MoorDynPoint point, double *out);

// Gets the mass matrix of a point and its end nodes, added mass included, row by row [kg].
int MoorDyn_GetPointM(MoorDynPoint point, double (*m)[3]);

// Gets the number of line ends attached to a point.
int MoorDyn_GetPointNAttached(MoorDynPoint point, unsigned int *n);

// Gets the line of attachment `i`, counted from 0, and the end of the line at the point: 0 for A, 1 for B.
int MoorDyn_GetPointAttached(MoorDynPoint point, unsigned int i, MoorDynLine *l, int *e);

// Not supported: a point has no geometry.
int MoorDyn_SavePointVTK(MoorDynPoint point, const char *_filename);

// Gets the number of a rod, as in the deck.
int MoorDyn_GetRodID(MoorDynRod rod, int *id);

// Gets the kind of a rod: always 2, fixed or on a body, since moorline models no other rods.
int MoorDyn_GetRodType(MoorDynRod rod, int *t);

// Not supported: a rod only carries line ends.
int MoorDyn_GetRodForce(MoorDynRod rod, double *_f);

// Not supported: a rod only carries line ends.
int MoorDyn_GetRodM(MoorDynRod rod, double (*_m)[6]);

// Gets the number of segments of a rod.
int MoorDyn_GetRodN(MoorDynRod rod, unsigned int *n);

// Gets the number of nodes of a rod.
int MoorDyn_GetRodNumberNodes(MoorDynRod rod, unsigned int *n);

// Gets the position [m] of node `i` of a rod, counted from 0 at end A.
int MoorDyn_GetRodNodePos(MoorDynRod rod, unsigned int i, double *out);

// Gets the velocity [m/s] of node `i` of a rod, counted from 0 at end A.
int MoorDyn_GetRodNodeVel(MoorDynRod rod, unsigned int i, double *out);

// Not supported: a rod only carries line ends.
int MoorDyn_SaveRodVTK(MoorDynRod rod, const char *_filename);

// Creates a system from a deck, by default `Mooring/lines.txt`; returns null and writes the reason to the console if the deck cannot be used.
MoorDyn MoorDyn_Create(const char *infilename);

// Gets the number of coupled degrees of freedom.
int MoorDyn_NCoupledDOF(MoorDyn system, unsigned int *n);

// Sets the lowest level of messages written to the console.
int MoorDyn_SetVerbosity(MoorDyn system, int verbosity);

// Writes messages to a file as well.
int MoorDyn_SetLogFile(MoorDyn system, const char *log_path);

// Sets the lowest level of messages written to the file.
int MoorDyn_SetLogLevel(MoorDyn system, int verbosity);

// Writes a message of the host to the log.
int MoorDyn_Log(MoorDyn system, int level, const char *msg);

// Starts in static equilibrium at the coupled positions `x` [m, rad], which move at `xd` [m/s, rad/s].
int MoorDyn_Init(MoorDyn system, const double *x, const double *xd);

// Starts as `MoorDyn_Init` does, but on catenaries instead of the equilibrium, for a state that is loaded next.
int MoorDyn_Init_NoIC(MoorDyn system, const double *x, const double *xd);

// Steps from `*t` by `*dt` [s] with the coupled positions `x` [m, rad] at the start of the step, which move at `xd` [m/s, rad/s]; gets the forces `f`
// [N, N m] on the coupled objects at the end of the step, and its time. A step of 0 s gets the current forces.
int MoorDyn_Step(MoorDyn system,
                 const double *x,
                 const double *xd,
                 double *f,
                 double *t,
                 double *dt);

// Closes a system; its handle and those of its parts become invalid.
int MoorDyn_Close(MoorDyn system);

// Gets the internal time step set by the deck or the host [s]; moorline chooses its own steps.
int MoorDyn_GetDt(MoorDyn system, double *dt);

// Sets an upper limit on the internal time step [s], which takes effect at the next start.
int MoorDyn_SetDt(MoorDyn system, double dt);

// Gets the Courant number set by the deck or the host [-]; moorline chooses its steps from the tolerance.
int MoorDyn_GetCFL(MoorDyn system, double *cfl);

// Stores a Courant number [-]; it has no effect.
int MoorDyn_SetCFL(MoorDyn system, double cfl);

// Gets the name of the time scheme set by the deck or the host. With a null name, gets only the size that the name needs [bytes].
int MoorDyn_GetTimeScheme(MoorDyn system, char *name, size_t *name_len);

// Stores the name of a time scheme; it has no effect.
int MoorDyn_SetTimeScheme(MoorDyn system, const char *name);

// Writes the state to a file.
int MoorDyn_SaveState(MoorDyn system, const char *filepath);

// Restores the state from a file; starts the system if it has not been started.
int MoorDyn_LoadState(MoorDyn system, const char *filepath);

// Writes the state to a file.
int MoorDyn_Save(MoorDyn system, const char *filepath);

// Restores the state from a file; starts the system if it has not been started.
int MoorDyn_Load(MoorDyn system, const char *filepath);

// Gets the size of the state [bytes] and, unless `data` is null, the state in words of eight bytes.
int MoorDyn_Serialize(MoorDyn system, size_t *size, uint64_t *data);

// Restores a state; starts the system if it has not been started.
int MoorDyn_Deserialize(MoorDyn system, const uint64_t *data);

// Writes the shape of all lines for ParaView.
int MoorDyn_SaveVTK(MoorDyn system, const char *filename);

// Detaches a line from a point, from the next step on.
int MoorDyn_BreakLine(MoorDyn system, MoorDynPoint point, MoorDynLine line);

// Gets the horizontal and vertical forces at the fairleads and anchors of the first `*numLines` lines [N].
int MoorDyn_GetFASTtens(MoorDyn system, const int *numLines, float *FairHTen, float *FairVTen, float *AnchHTen, float *AnchVTen);

// Gets the number of bodies.
int MoorDyn_GetNumberBodies(MoorDyn system, unsigned int *n);

// Gets the number of rods.
int MoorDyn_GetNumberRods(MoorDyn system, unsigned int *n);

// Gets the number of points.
int MoorDyn_GetNumberPoints(MoorDyn system, unsigned int *n);

// Gets the number of lines.
int MoorDyn_GetNumberLines(MoorDyn system, unsigned int *n);

// Returns the handle of a body by its number, from 1; null if there is none.
MoorDynBody MoorDyn_GetBody(MoorDyn system, unsigned int number);

// Returns the handle of a rod by its number, from 1; null if there is none.
MoorDynRod MoorDyn_GetRod(MoorDyn system, unsigned int number);

// Returns the handle of a point by its number, from 1; null if there is none.
MoorDynPoint MoorDyn_GetPoint(MoorDyn system, unsigned int number);

// Returns the handle of a line by its number, from 1; null if there is none.
MoorDynLine MoorDyn_GetLine(MoorDyn system, unsigned int number);

// Returns the handle of the water.
MoorDynWaves MoorDyn_GetWaves(MoorDyn system);

// Returns the handle of the seabed; null if there is none.
MoorDynSeafloor MoorDyn_GetSeafloor(MoorDyn system);

// Gets velocity `U` [m/s], acceleration `Ud` [m/s²], surface elevation [m] and dynamic pressure [Pa] of the water at a position [m]. The pressure of
// waves is not computed: with waves, pass null for it.
int MoorDyn_GetWavesKin(MoorDynWaves waves,
                        double x,
                        double y,
                        double z,
                        double *U,
                        double *Ud,
                        double *zeta,
                        double *PDyn,
                        MoorDynSeafloor _seafloor);

// Returns the wave number [1/m] for a circular frequency [rad/s], gravity `g` [m/s²] and depth `h` [m]; NaN if one of them is not positive.
double WaveNumber(double Omega,
                  double g,
                  double h);

// Gets the height z of the seabed at a horizontal position [m], negative below still water.
int MoorDyn_GetDepthAt(MoorDynSeafloor seafloor, double x, double y, double *depth);

// Gets the mean height z of the soundings [m].
int MoorDyn_GetAverageDepth(MoorDynSeafloor seafloor, double *avgDepth);

// Gets the height z of the shallowest sounding [m].
int MoorDyn_GetMinDepth(MoorDynSeafloor seafloor, double *minDepth);

// Not supported: moorline does not model water kinematics from the host; sets `n` to 0.
int MoorDyn_ExternalWaveKinInit(MoorDyn system, unsigned int *n);

// Not supported, as `MoorDyn_ExternalWaveKinInit`; sets `n` to 0.
int MoorDyn_ExternalWaveKinGetN(MoorDyn system, unsigned int *n);

// Not supported, as `MoorDyn_ExternalWaveKinInit`.
int MoorDyn_ExternalWaveKinGetCoordinates(MoorDyn system, double *_r);

// Not supported, as `MoorDyn_ExternalWaveKinInit`.
int MoorDyn_ExternalWaveKinSet(MoorDyn system, const double *_U, const double *_Ud, double _t);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MOORLINE_MOORDYN2_H */
