/* Octave and Matlab: force = moorline_run(scene, displacements, step) drives the first body of a scene by the rows of `displacements` [m, rad] and
 * returns the force [N, N m] after every step, a row each.
 *
 *     mkoctfile --mex -Icapi/include capi/examples/moorline_run.c -Ltarget/release -lmoorline_c
 *
 * Matlab can also load the library as it is: loadlibrary('libmoorline_c', 'moorline.h'). */
#include "mex.h"
#include "moorline.h"

static void must(moorline_simulation mooring, int code) {
    if (code != MOORLINE_OK) {
        char text[512] = "";
        moorline_message(text, sizeof text, NULL);
        moorline_close(mooring);
        mexErrMsgTxt(text);
    }
}

void mexFunction(int results, mxArray *result[], int arguments, const mxArray *argument[]) {
    moorline_simulation mooring = NULL;
    double place[6], force[6];
    size_t size;
    if (arguments != 3 || results > 1 || !mxIsChar(argument[0]) || !mxIsDouble(argument[1]))
        mexErrMsgTxt("moorline_run(scene, displacements, step): a path, a matrix, a time in seconds");
    char *path = mxArrayToString(argument[0]);
    must(mooring, moorline_load(MOORLINE_ABI_VERSION, path, &mooring));
    mxFree(path);
    must(mooring, moorline_body_size(mooring, 0, &size));
    const size_t rows = mxGetM(argument[1]);
    if (mxGetN(argument[1]) != size) {
        moorline_close(mooring);
        mexErrMsgTxt("displacements has a column for each degree of freedom of the first body");
    }
    result[0] = mxCreateDoubleMatrix(rows, size, mxREAL);
    must(mooring, moorline_start(mooring, 0.0));
    for (size_t k = 0; k < rows; k++) {
        for (size_t axis = 0; axis < size; axis++)
            place[axis] = mxGetPr(argument[1])[k + axis * rows];
        must(mooring, moorline_move(mooring, 0, place, NULL, size));
        must(mooring, moorline_step(mooring, mxGetScalar(argument[2])));
        must(mooring, moorline_force(mooring, 0, force, size));
        for (size_t axis = 0; axis < size; axis++)
            mxGetPr(result[0])[k + axis * rows] = force[axis];
    }
    moorline_close(mooring);
}
