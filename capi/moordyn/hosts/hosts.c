/* Hosts of MoorDyn's C interface, in small: the calls that WEC-Sim, HydroChrono, foamMooring and ERF make, in their order, on any library that
 * has the interface. Written after a table of their calls, not after their code.
 *
 *     hosts LIBRARY HOST DECK FREEDOM MOTION STEP FORCES
 *
 * drives a deck with so many coupled degrees of freedom along a motion: a file of doubles, for every step the coupled positions and velocities at its start. It writes the forces
 * after every step to another such file, and prints the processor time of the steps, in seconds. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "MoorDyn.h"

/* The functions that are called, each with the type of the header. */
#define FUNCTIONS(F) \
    F(MoorDynInit) F(MoorDynStep) F(MoorDynClose) F(SetDisableConsole) F(GetFASTtens) F(GetNodePos) F(MoorDyn_Create) \
    F(MoorDyn_SetVerbosity) F(MoorDyn_NCoupledDOF) F(MoorDyn_Init) F(MoorDyn_Init_NoIC) F(MoorDyn_Step) F(MoorDyn_Close) \
    F(MoorDyn_GetNumberLines) F(MoorDyn_GetLine) F(MoorDyn_GetLineFairTen) F(MoorDyn_GetNumberPoints) F(MoorDyn_GetPoint) \
    F(MoorDyn_GetPointPos) F(MoorDyn_Save) F(MoorDyn_Load) F(MoorDyn_Serialize) F(MoorDyn_Deserialize) F(MoorDyn_SaveVTK) \
    F(MoorDyn_ExternalWaveKinInit)

#define DECLARE(name) static __typeof__(&name) call_##name;
FUNCTIONS(DECLARE)

enum { OBJECTS_MAX = 64 };

struct run {
    const char *deck;
    double *motion, *forces;
    double step, seconds;
    unsigned int freedom;
    size_t count;
    MoorDyn system;
};

static void must(int code, const char *what) {
    if (code != 0) {
        fprintf(stderr, "%s returns %d\n", what, code);
        exit(1);
    }
}

#define MUST(name, ...) must(call_##name(__VA_ARGS__), #name)

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static const double *positions(const struct run *run, size_t k) {
    return run->motion + 2 * k * run->freedom;
}

static const double *velocities(const struct run *run, size_t k) {
    return positions(run, k) + run->freedom;
}

/* The deck's name with another ending. */
static const char *beside(const struct run *run, const char *ending) {
    static char path[4096];
    snprintf(path, sizeof path, "%s%s", run->deck, ending);
    return path;
}

/* One system per process. */
static void wec_sim(struct run *run) {
    call_SetDisableConsole(1);
    MUST(MoorDynInit, positions(run, 0), velocities(run, 0), run->deck);
    const double start = now();
    for (size_t k = 0; k < run->count; k++) {
        double t = (double)k * run->step, dt = run->step, node[3];
        MUST(MoorDynStep, positions(run, k), velocities(run, k), run->forces + k * run->freedom, &t, &dt);
        MUST(GetNodePos, 1, 1, node);
    }
    run->seconds = now() - start;
    int lines = 1;
    float fair_h, fair_v, anchor_h, anchor_v;
    MUST(GetFASTtens, &lines, &fair_h, &fair_v, &anchor_h, &anchor_v);
    MUST(MoorDynClose);
}

static void create(struct run *run) {
    unsigned int freedom;
    run->system = call_MoorDyn_Create(run->deck);
    must(run->system == NULL, "MoorDyn_Create");
    MUST(MoorDyn_SetVerbosity, run->system, MOORDYN_NO_OUTPUT);
    MUST(MoorDyn_NCoupledDOF, run->system, &freedom);
    must(freedom != run->freedom, "MoorDyn_NCoupledDOF");
}

static void step(struct run *run, size_t k) {
    double t = (double)k * run->step, dt = run->step;
    MUST(MoorDyn_Step, run->system, positions(run, k), velocities(run, k), run->forces + k * run->freedom, &t, &dt);
}

/* Steps, and reads tensions and places after each. */
static void hydrochrono(struct run *run) {
    MoorDynLine line[OBJECTS_MAX];
    MoorDynPoint point[OBJECTS_MAX];
    unsigned int lines, points;
    create(run);
    MUST(MoorDyn_Init, run->system, positions(run, 0), velocities(run, 0));
    MUST(MoorDyn_GetNumberLines, run->system, &lines);
    MUST(MoorDyn_GetNumberPoints, run->system, &points);
    must(lines > OBJECTS_MAX || points > OBJECTS_MAX, "the room for objects");
    for (unsigned int i = 0; i < lines; i++)
        line[i] = call_MoorDyn_GetLine(run->system, i + 1);
    for (unsigned int i = 0; i < points; i++)
        point[i] = call_MoorDyn_GetPoint(run->system, i + 1);
    const double start = now();
    for (size_t k = 0; k < run->count; k++) {
        double tension, place[3];
        step(run, k);
        for (unsigned int i = 0; i < lines; i++)
            MUST(MoorDyn_GetLineFairTen, line[i], &tension);
        for (unsigned int i = 0; i < points; i++)
            MUST(MoorDyn_GetPointPos, point[i], place);
    }
    run->seconds = now() - start;
    MUST(MoorDyn_Close, run->system);
}

/* Iterates every step from a serialised state, and restarts from a file half way. */
static void foam_mooring(struct run *run) {
    create(run);
    MUST(MoorDyn_Init, run->system, positions(run, 0), velocities(run, 0));
    double start = now();
    for (size_t k = 0; k < run->count; k++) {
        if (k == run->count / 2) {
            run->seconds += now() - start;
            MUST(MoorDyn_Save, run->system, beside(run, ".saved"));
            MUST(MoorDyn_Close, run->system);
            create(run);
            MUST(MoorDyn_Init_NoIC, run->system, positions(run, 0), velocities(run, 0));
            MUST(MoorDyn_Load, run->system, beside(run, ".saved"));
            start = now();
        }
        size_t size = 0;
        MUST(MoorDyn_Serialize, run->system, &size, NULL);
        uint64_t *state = malloc(size);
        MUST(MoorDyn_Serialize, run->system, &size, state);
        /* a poor guess of the motion first, as of a flow solver that has not converged */
        double t = (double)k * run->step, dt = run->step;
        const size_t other = k + 1 < run->count ? k + 1 : k;
        MUST(MoorDyn_Step, run->system, positions(run, k), velocities(run, other), run->forces + k * run->freedom, &t, &dt);
        MUST(MoorDyn_Deserialize, run->system, state);
        free(state);
        step(run, k);
    }
    run->seconds += now() - start;
    MUST(MoorDyn_SaveVTK, run->system, beside(run, "_shape.vtm"));
    MUST(MoorDyn_Close, run->system);
}

/* Asks for the places of water that the host would give: a library without it says so by its code, and steps in the deck's water. */
static void drive_erf(struct run *run) {
    unsigned int places = 0;
    create(run);
    MUST(MoorDyn_Init, run->system, positions(run, 0), velocities(run, 0));
    const int code = call_MoorDyn_ExternalWaveKinInit(run->system, &places);
    must(code != MOORDYN_SUCCESS && code != MOORDYN_NOT_IMPLEMENTED, "MoorDyn_ExternalWaveKinInit");
    must(code == MOORDYN_NOT_IMPLEMENTED && places != 0, "MoorDyn_ExternalWaveKinInit");
    const double start = now();
    for (size_t k = 0; k < run->count; k++)
        step(run, k);
    run->seconds = now() - start;
    MUST(MoorDyn_Close, run->system);
}

static double *read_all(const char *path, size_t *count) {
    FILE *file = fopen(path, "rb");
    must(file == NULL, path);
    fseek(file, 0, SEEK_END);
    *count = (size_t)ftell(file) / sizeof(double);
    rewind(file);
    double *values = malloc(*count * sizeof(double));
    must(fread(values, sizeof(double), *count, file) != *count, path);
    fclose(file);
    return values;
}

int main(int count, char **words) {
    const struct {
        const char *name;
        void (*drive)(struct run *);
    } hosts[] = {{"wec_sim", wec_sim}, {"hydrochrono", hydrochrono}, {"foam_mooring", foam_mooring}, {"erf", drive_erf}};
    must(count != 8, "hosts LIBRARY HOST DECK FREEDOM MOTION STEP FORCES");
    void *library = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
#define LOAD(name) *(void **)&call_##name = dlsym(library, #name); must(call_##name == NULL, #name);
    FUNCTIONS(LOAD)
    struct run run = {.deck = words[3], .freedom = (unsigned int)atoi(words[4]), .step = atof(words[6])};
    run.motion = read_all(words[5], &run.count);
    run.count /= 2 * run.freedom;
    run.forces = calloc(run.count * run.freedom, sizeof(double));
    for (size_t i = 0; i < sizeof hosts / sizeof *hosts; i++)
        if (strcmp(hosts[i].name, words[2]) == 0)
            hosts[i].drive(&run);
    FILE *file = fopen(words[7], "wb");
    must(file == NULL, words[7]);
    fwrite(run.forces, sizeof(double), run.count * run.freedom, file);
    must(fclose(file), words[7]);
    printf("processor time %.6f\n", run.seconds);
    free(run.motion);
    free(run.forces);
    return 0;
}
