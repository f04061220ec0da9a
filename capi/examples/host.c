/* A host in C: loads a scene, drives its first body, reads forces and the shape of a line.
 *
 *     cc -I capi/include capi/examples/host.c -L target/release -lmoorline_c -lm -o host && ./host scenes/oc3_catenary.toml
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "moorline.h"

static void must(int code) {
    if (code != MOORLINE_OK) {
        char text[512] = "";
        moorline_message(text, sizeof text, NULL);
        fprintf(stderr, "%s\n", text);
        exit(1);
    }
}

int main(int count, char **words) {
    const double step = 0.05, pi = 3.141592653589793;
    double place[6] = {0}, force[6], time;
    moorline_simulation mooring;
    size_t size, nodes;

    must(moorline_load(MOORLINE_ABI_VERSION, count > 1 ? words[1] : "scenes/oc3_catenary.toml", &mooring));
    must(moorline_start(mooring, 0.0));
    must(moorline_body_size(mooring, 0, &size));
    for (int k = 0; k < 600; k++) {
        must(moorline_time(mooring, &time));
        place[0] = 5.0 * fmin(time / 20.0, 1.0) * sin(2.0 * pi * time / 12.0); /* [m] */
        must(moorline_move(mooring, 0, place, NULL, size));
        must(moorline_step(mooring, step));
        must(moorline_force(mooring, 0, force, size));
    }
    must(moorline_node_count(mooring, 0, &nodes));
    double *shape = malloc(3 * nodes * sizeof *shape);
    must(moorline_node_positions(mooring, 0, shape, 3 * nodes));
    must(moorline_time(mooring, &time));
    printf("t = %.2f s, force %.6e %.6e %.6e N, last node at z = %.4f m\n", time, force[0], force[1], force[2], shape[3 * nodes - 1]);
    free(shape);
    must(moorline_close(mooring));
    return 0;
}
