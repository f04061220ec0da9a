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

// Memory.
#define MOORDYN_MEM_ERROR -5

// An argument has a value that cannot be used; null is one.
#define MOORDYN_INVALID_VALUE -6

// moorline does not model it.
#define MOORDYN_NOT_IMPLEMENTED -7

// Anything else.
#define MOORDYN_UNHANDLED_ERROR -255

// Level of messages from which on nothing is written.
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

// Creates and starts the one system of the first interface, in place of an earlier one.
int MoorDynInit(const double *x, const double *xd, const char *infilename);

// Steps the system as `MoorDyn_Step`.
int MoorDynStep(const double *x, const double *xd, double *f, double *t, double *dt);

// Closes the system.
int MoorDynClose(void);

// Writes messages to the console unless `disable` is other than 0; holds for the next system too.
void SetDisableConsole(int disable);

// Returns the tension of the last segment of a line [N] by its number, from 1; NaN where there is none.
double GetFairTen(int l);

// Gives the tensions of the first `*numLines` lines as `MoorDyn_GetFASTtens`.
int GetFASTtens(const int *numLines, float *FairHTen, float *FairVTen, float *AnchHTen, float *AnchVTen);

// Gives the position [m] of a point by its number, from 1.
int GetPointPos(int l, double *pos);

// Gives the force [N] on a point by its number, from 1.
int GetPointForce(int l, double *force);

// Gives the position [m] of a node, from 0, of a line, from 1.
int GetNodePos(int LineNum, int NodeNum, double *pos);

// Is not modelled.
int externalWaveKinInit(void);

// Is not modelled; the log says so.
void getWaveKinCoordinates(double *_r);

// Is not modelled; the log says so.
void setWaveKin(const double *_U, const double *_Ud, double _t);

// Does nothing: `MoorDynStep` writes the files of channels.
void AllOutput(double _t, double _dt);

// Gives the number of a line in the deck.
int MoorDyn_GetLineID(MoorDynLine l, int *id);

// Gives the number of segments of a line.
int MoorDyn_GetLineN(MoorDynLine l, unsigned int *n);

// Gives the number of nodes of a line.
int MoorDyn_GetLineNumberNodes(MoorDynLine l, unsigned int *n);

// Gives the unstretched length of a line [m].
int MoorDyn_GetLineUnstretchedLength(MoorDynLine l, double *ul);

// Sets the unstretched length of a line [m], before the start only.
int MoorDyn_SetLineUnstretchedLength(MoorDynLine l, double ul);

// Refuses a rate of the unstretched length [m/s] other than 0.
int MoorDyn_SetLineUnstretchedLengthVel(MoorDynLine l, double v);

// Gives 1 where a line has one constant axial stiffness, else 0.
int MoorDyn_IsLineConstantEA(MoorDynLine l, int *b);

// Gives the axial stiffness of a line [N].
int MoorDyn_GetLineConstantEA(MoorDynLine l, double *EA);

// Sets the axial stiffness of a line [N], before the start only.
int MoorDyn_SetLineConstantEA(MoorDynLine l, double EA);

// Gives 0: bending by pressure is not modelled.
int MoorDyn_IsLinePressBend(MoorDynLine l, int *b);

// Refuses bending by pressure.
int MoorDyn_SetLinePressBend(MoorDynLine l, int b);

// Is not modelled.
int MoorDyn_SetLinePressInt(MoorDynLine l, const double *_p);

// Gives the position [m] of a node of a line, from end A.
int MoorDyn_GetLineNodePos(MoorDynLine l, unsigned int i, double *out);

// Gives the velocity [m/s] of a node of a line, from end A.
int MoorDyn_GetLineNodeVel(MoorDynLine l, unsigned int i, double *out);

// Gives the sum of all forces but inertia [N] of a node of a line, from end A.
int MoorDyn_GetLineNodeForce(MoorDynLine l, unsigned int i, double *out);

// Gives the tension, towards end B [N], of a node of a line, from end A.
int MoorDyn_GetLineNodeTen(MoorDynLine l, unsigned int i, double *out);

// Gives the force of bending stiffness [N] of a node of a line, from end A.
int MoorDyn_GetLineNodeBendStiff(MoorDynLine l, unsigned int i, double *out);

// Gives the weight less buoyancy [N] of a node of a line, from end A.
int MoorDyn_GetLineNodeWeight(MoorDynLine l, unsigned int i, double *out);

// Gives the drag [N] of a node of a line, from end A.
int MoorDyn_GetLineNodeDrag(MoorDynLine l, unsigned int i, double *out);

// Gives the force of accelerated water [N] of a node of a line, from end A.
int MoorDyn_GetLineNodeFroudeKrilov(MoorDynLine l, unsigned int i, double *out);

// Gives the force of the seabed [N] of a node of a line, from end A.
int MoorDyn_GetLineNodeSeabedForce(MoorDynLine l, unsigned int i, double *out);

// Gives the curvature of a line at a node [1/m]; 0 without bending stiffness.
int MoorDyn_GetLineNodeCurv(MoorDynLine l, unsigned int i, double *curv);

// Gives the mass matrix of a node of a line, added mass included, by rows [kg].
int MoorDyn_GetLineNodeM(MoorDynLine l, unsigned int i, double (*m)[3]);

// Gives the tension of the last segment of a line at end B [N].
int MoorDyn_GetLineFairTen(MoorDynLine l, double *t);

// Gives the greatest tension of all nodes of a line [N].
int MoorDyn_GetLineMaxTen(MoorDynLine l, double *t);

// Writes the shape of a line for ParaView.
int MoorDyn_SaveLineVTK(MoorDynLine l, const char *filename);

// Gives the number of a body in the deck.
int MoorDyn_GetBodyID(MoorDynBody b, int *id);

// Gives the kind of a body: -1 coupled, 0 free, 1 fixed.
int MoorDyn_GetBodyType(MoorDynBody b, int *t);

// Gives position [m] and angles [rad] of a body, and their rates [m/s, rad/s].
int MoorDyn_GetBodyState(MoorDynBody b, double *r, double *rd);

// Gives the position of a body [m].
int MoorDyn_GetBodyPos(MoorDynBody b, double *out);

// Gives the roll, pitch and yaw of a body by Rx Ry Rz [rad].
int MoorDyn_GetBodyAngle(MoorDynBody b, double *out);

// Gives the velocity of a body [m/s].
int MoorDyn_GetBodyVel(MoorDynBody b, double *out);

// Gives the angular velocity of a body [rad/s].
int MoorDyn_GetBodyAngVel(MoorDynBody b, double *out);

// Gives force [N] and moment [N m] of the lines on a coupled body, about its reference point.
int MoorDyn_GetBodyForce(MoorDynBody b, double *f);

// Gives the mass matrix of the end nodes on a coupled body, added mass included, by rows [kg, kg m, kg m²].
int MoorDyn_GetBodyM(MoorDynBody b, double (*m)[6]);

// Is not modelled: a body has no shape.
int MoorDyn_SaveBodyVTK(MoorDynBody b, const char *_filename);

// Gives the number of a point in the deck.
int MoorDyn_GetPointID(MoorDynPoint point, int *id);

// Gives the kind of a point: -1 coupled, 0 free, 1 fixed or carried by a body.
int MoorDyn_GetPointType(MoorDynPoint point, int *t);

// Gives the position of a point [m].
int MoorDyn_GetPointPos(MoorDynPoint point, double *out);

// Gives the velocity of a point [m/s].
int MoorDyn_GetPointVel(MoorDynPoint point, double *out);

// Gives the force of the lines on a point and of the point itself [N].
int MoorDyn_GetPointForce(MoorDynPoint point, double *out);

// Gives the mass matrix of a point and the end nodes on it, added mass included, by rows [kg].
int MoorDyn_GetPointM(MoorDynPoint point, double (*m)[3]);

// Gives the number of line ends at a point.
int MoorDyn_GetPointNAttached(MoorDynPoint point, unsigned int *n);

// Gives the handle of the line of attachment `i`, from 0, and its end there: 0 of A, 1 of B.
int MoorDyn_GetPointAttached(MoorDynPoint point, unsigned int i, MoorDynLine *l, int *e);

// Is not modelled: a point has no shape.
int MoorDyn_SavePointVTK(MoorDynPoint point, const char *_filename);

// Gives the number of a rod in the deck.
int MoorDyn_GetRodID(MoorDynRod rod, int *id);

// Gives the kind of a rod: 1, fixed or carried by a body, as moorline models no others.
int MoorDyn_GetRodType(MoorDynRod rod, int *t);

// Is not modelled: a rod only holds the ends of lines.
int MoorDyn_GetRodForce(MoorDynRod rod, double *_f);

// Is not modelled: a rod only holds the ends of lines.
int MoorDyn_GetRodM(MoorDynRod rod, double (*_m)[6]);

// Gives the number of segments of a rod.
int MoorDyn_GetRodN(MoorDynRod rod, unsigned int *n);

// Gives the number of nodes of a rod.
int MoorDyn_GetRodNumberNodes(MoorDynRod rod, unsigned int *n);

// Gives the position [m] of a node of a rod, from end A.
int MoorDyn_GetRodNodePos(MoorDynRod rod, unsigned int i, double *out);

// Gives the velocity [m/s] of a node of a rod, from end A.
int MoorDyn_GetRodNodeVel(MoorDynRod rod, unsigned int i, double *out);

// Is not modelled: a rod only holds the ends of lines.
int MoorDyn_SaveRodVTK(MoorDynRod rod, const char *_filename);

// Creates a system from a deck, by default `Mooring/lines.txt`; null where the deck cannot be used, with the reason in the console.
MoorDyn MoorDyn_Create(const char *infilename);

// Gives the number of coupled degrees of freedom.
int MoorDyn_NCoupledDOF(MoorDyn system, unsigned int *n);

// Sets the least level of messages in the console.
int MoorDyn_SetVerbosity(MoorDyn system, int verbosity);

// Writes messages to a file too.
int MoorDyn_SetLogFile(MoorDyn system, const char *log_path);

// Sets the least level of messages in the file.
int MoorDyn_SetLogLevel(MoorDyn system, int verbosity);

// Writes a message of the host.
int MoorDyn_Log(MoorDyn system, int level, const char *msg);

// Starts in static equilibrium at coupled positions `x` [m, rad] that move by `xd` [m/s, rad/s].
int MoorDyn_Init(MoorDyn system, const double *x, const double *xd);

// Starts as `MoorDyn_Init`, but on catenaries in place of the equilibrium, for a state that is loaded next.
int MoorDyn_Init_NoIC(MoorDyn system, const double *x, const double *xd);

// Steps from `*t` by `*dt` [s] with coupled positions `x` [m, rad] at the start, which move by `xd` [m/s, rad/s]; gives the forces `f` [N, N m] on the
// coupled objects at the end, and its time. A step of 0 s gives the present forces.
int MoorDyn_Step(MoorDyn system,
                 const double *x,
                 const double *xd,
                 double *f,
                 double *t,
                 double *dt);

// Closes a system; its handles and those of its parts are refused from then on.
int MoorDyn_Close(MoorDyn system);

// Gives the internal time step of the deck or the host [s]; moorline chooses its own.
int MoorDyn_GetDt(MoorDyn system, double *dt);

// Sets an upper limit of the internal time step [s], which holds from the next start on.
int MoorDyn_SetDt(MoorDyn system, double dt);

// Gives the Courant number of the deck or the host [-]; moorline chooses its steps by the tolerance.
int MoorDyn_GetCFL(MoorDyn system, double *cfl);

// Keeps a Courant number [-], which has no effect.
int MoorDyn_SetCFL(MoorDyn system, double cfl);

// Gives the name of the time scheme of the deck or the host. With a null name, only the room that it needs [bytes].
int MoorDyn_GetTimeScheme(MoorDyn system, char *name, size_t *name_len);

// Keeps the name of a time scheme, which has no effect.
int MoorDyn_SetTimeScheme(MoorDyn system, const char *name);

// Writes the state to a file.
int MoorDyn_SaveState(MoorDyn system, const char *filepath);

// Goes back to the state of a file; a system that was not started then is.
int MoorDyn_LoadState(MoorDyn system, const char *filepath);

// Writes the state to a file.
int MoorDyn_Save(MoorDyn system, const char *filepath);

// Goes back to the state of a file; a system that was not started then is.
int MoorDyn_Load(MoorDyn system, const char *filepath);

// Gives the number of bytes of the state and, unless `data` is null, the state in words of eight bytes.
int MoorDyn_Serialize(MoorDyn system, size_t *size, uint64_t *data);

// Goes back to a state; a system that was not started then is.
int MoorDyn_Deserialize(MoorDyn system, const uint64_t *data);

// Writes the shape of all lines for ParaView.
int MoorDyn_SaveVTK(MoorDyn system, const char *filename);

// Breaks a line off a point, from the next step on.
int MoorDyn_BreakLine(MoorDyn system, MoorDynPoint point, MoorDynLine line);

// Gives horizontal and vertical forces at the fairleads and anchors of the first `*numLines` lines [N].
int MoorDyn_GetFASTtens(MoorDyn system, const int *numLines, float *FairHTen, float *FairVTen, float *AnchHTen, float *AnchVTen);

// Gives the number of bodies.
int MoorDyn_GetNumberBodies(MoorDyn system, unsigned int *n);

// Gives the number of rods.
int MoorDyn_GetNumberRods(MoorDyn system, unsigned int *n);

// Gives the number of points.
int MoorDyn_GetNumberPoints(MoorDyn system, unsigned int *n);

// Gives the number of lines.
int MoorDyn_GetNumberLines(MoorDyn system, unsigned int *n);

// Returns the handle of a body by its number, from 1; null where there is none.
MoorDynBody MoorDyn_GetBody(MoorDyn system, unsigned int number);

// Returns the handle of a rod by its number, from 1; null where there is none.
MoorDynRod MoorDyn_GetRod(MoorDyn system, unsigned int number);

// Returns the handle of a point by its number, from 1; null where there is none.
MoorDynPoint MoorDyn_GetPoint(MoorDyn system, unsigned int number);

// Returns the handle of a line by its number, from 1; null where there is none.
MoorDynLine MoorDyn_GetLine(MoorDyn system, unsigned int number);

// Returns the handle of the water.
MoorDynWaves MoorDyn_GetWaves(MoorDyn system);

// Returns the handle of the seabed; null where there is none.
MoorDynSeafloor MoorDyn_GetSeafloor(MoorDyn system);

// Gives velocity `U` [m/s], acceleration `Ud` [m/s²], elevation [m] and dynamic pressure [Pa] of the water at a place [m]. The pressure of waves is
// not found: give null for it where there are waves.
int MoorDyn_GetWavesKin(MoorDynWaves waves,
                        double x,
                        double y,
                        double z,
                        double *U,
                        double *Ud,
                        double *zeta,
                        double *PDyn,
                        MoorDynSeafloor _seafloor);

// Returns the wave number [1/m] of a circular frequency [rad/s] with gravity `g` [m/s²] over a depth `h` [m]; NaN where one of them is not positive.
double WaveNumber(double Omega,
                  double g,
                  double h);

// Gives the depth of the seabed at a place [m], positive down.
int MoorDyn_GetDepthAt(MoorDynSeafloor seafloor, double x, double y, double *depth);

// Gives the mean of the soundings [m].
int MoorDyn_GetAverageDepth(MoorDynSeafloor seafloor, double *avgDepth);

// Gives the least of the soundings [m].
int MoorDyn_GetMinDepth(MoorDynSeafloor seafloor, double *minDepth);

// Is not modelled; gives 0 places.
int MoorDyn_ExternalWaveKinInit(MoorDyn system, unsigned int *n);

// Is not modelled; gives 0 places.
int MoorDyn_ExternalWaveKinGetN(MoorDyn system, unsigned int *n);

// Is not modelled.
int MoorDyn_ExternalWaveKinGetCoordinates(MoorDyn system, double *_r);

// Is not modelled.
int MoorDyn_ExternalWaveKinSet(MoorDyn system, const double *_U, const double *_Ud, double _t);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MOORLINE_MOORDYN2_H */
