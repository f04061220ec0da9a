% A host in Octave: the one of host.c, through moorline_run.c.
scene = getenv('SCENE');
t = (0:599)' * 0.05;
place = [5 * min(t / 20, 1) .* sin(2 * pi * t / 12), zeros(600, 2)];
force = moorline_run(scene, place, 0.05);
printf('t = 30.00 s, force %.6e %.6e %.6e N\n', force(end, :));
