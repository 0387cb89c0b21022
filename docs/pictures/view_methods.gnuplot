$all0_0 << EOD
1.28 3.11e-05 "CPU"
6.72 3.46e-05 "GL"
EOD
$grey0_0 << EOD
6.72 3.46e-05 "GL"
EOD
$all0_1 << EOD
3.2 6.42 "planes 15 mm apart"
5.7 2.24 "planes 5 mm apart"
20 0.479 "planes 1 mm apart"
EOD
$grey0_1 << EOD
3.2 6.42 "planes 15 mm apart"
5.7 2.24 "planes 5 mm apart"
20 0.479 "planes 1 mm apart"
EOD
$all0_2 << EOD
40.3 6.42 "planes 15 mm apart"
112 2.24 "planes 5 mm apart"
EOD
$grey0_2 << EOD
40.3 6.42 "planes 15 mm apart"
112 2.24 "planes 5 mm apart"
EOD
$all0_3 << EOD
551 6.33 "planes 15 mm apart"
EOD
$grey0_3 << EOD
551 6.33 "planes 15 mm apart"
EOD
$all0_4 << EOD
17.6 0.207 "edges of 2 mm"
6.98 0.367 "edges of 4 mm"
3.94 0.795 "edges of 8 mm"
EOD
$grey0_4 << EOD
17.6 0.207 "edges of 2 mm"
6.98 0.367 "edges of 4 mm"
3.94 0.795 "edges of 8 mm"
EOD
$all1_0 << EOD
5.04 0.0259 "CPU"
19.4 0.0259 "GL"
EOD
$grey1_0 << EOD
19.4 0.0259 "GL"
EOD
$all1_1 << EOD
5.59 6.2 "planes 15 mm apart"
8.67 2.2 "planes 5 mm apart"
28.7 0.51 "planes 1 mm apart"
EOD
$grey1_1 << EOD
5.59 6.2 "planes 15 mm apart"
8.67 2.2 "planes 5 mm apart"
28.7 0.51 "planes 1 mm apart"
EOD
$all1_2 << EOD
82.1 6.2 "planes 15 mm apart"
244 2.2 "planes 5 mm apart"
EOD
$grey1_2 << EOD
82.1 6.2 "planes 15 mm apart"
244 2.2 "planes 5 mm apart"
EOD
$all1_3 << EOD
1360 6.09 "planes 15 mm apart"
EOD
$grey1_3 << EOD
1360 6.09 "planes 15 mm apart"
EOD
$all1_4 << EOD
43.3 0.227 "edges of 2 mm"
20.3 0.399 "edges of 4 mm"
13.8 0.791 "edges of 8 mm"
EOD
$grey1_4 << EOD
43.3 0.227 "edges of 2 mm"
20.3 0.399 "edges of 4 mm"
13.8 0.791 "edges of 8 mm"
EOD
set logscale xy
set grid lc rgb '#cccccc'
set border 3
set tics nomirror
set key bottom right Left reverse
set xlabel 'masks in memory to depth, one thread, ms (median)'
set ylabel 'RMS distance to the hull of the masks, mm'
set format xy '%g'
set offsets graph 0.08, graph 0.28, graph 0.15, graph 0.1
set terminal svg size 900,1120 font 'Sans,15' background rgb 'white'
set output 'view_methods.svg'
set multiplot layout 2,1
set title 'Views of 640 x 480 from 3 cameras, 640 x 480: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, $all0_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plane sweep, GL', $grey0_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_2 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#009E73' notitle, $all0_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'the paper''s sweep, GL', $grey0_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_3 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#CC79A7' notitle, $all0_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'octree mesh', $grey0_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
set title 'Views of 640 x 480 from 8 cameras, 1280 x 720: run time against error'
plot $all1_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey1_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all1_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey1_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, $all1_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plane sweep, GL', $grey1_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_2 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#009E73' notitle, $all1_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'the paper''s sweep, GL', $grey1_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_3 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#CC79A7' notitle, $all1_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'octree mesh', $grey1_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
set terminal pngcairo size 1350,1680 font 'Sans,17'
set output 'view_methods.png'
set multiplot layout 2,1
set title 'Views of 640 x 480 from 3 cameras, 640 x 480: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, $all0_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plane sweep, GL', $grey0_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_2 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#009E73' notitle, $all0_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'the paper''s sweep, GL', $grey0_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_3 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#CC79A7' notitle, $all0_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'octree mesh', $grey0_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
set title 'Views of 640 x 480 from 8 cameras, 1280 x 720: run time against error'
plot $all1_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey1_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all1_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey1_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, $all1_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plane sweep, GL', $grey1_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_2 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#009E73' notitle, $all1_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'the paper''s sweep, GL', $grey1_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_3 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#CC79A7' notitle, $all1_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'octree mesh', $grey1_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
