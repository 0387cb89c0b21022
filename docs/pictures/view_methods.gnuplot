$all0_0 << EOD
1.071111 3.110487184156514e-05 "CPU"
5.365786 3.456495934914582e-05 "GL"
EOD
$grey0_0 << EOD
5.365786 3.456495934914582e-05 "GL"
EOD
$all0_1 << EOD
2.673018 6.4196256297815735 "planes 15 mm apart"
4.770423 2.238645512054733 "planes 5 mm apart"
16.696009 0.47912261597162503 "planes 1 mm apart"
EOD
$grey0_1 << EOD
2.673018 6.4196256297815735 "planes 15 mm apart"
4.770423 2.238645512054733 "planes 5 mm apart"
16.696009 0.47912261597162503 "planes 1 mm apart"
EOD
$all0_2 << EOD
14.599729 6.4196256297815735 "planes 15 mm apart"
EOD
$grey0_2 << EOD
14.599729 6.4196256297815735 "planes 15 mm apart"
EOD
$all0_3 << EOD
26.072878 6.417599769735659 "planes 15 mm apart"
72.715193 2.2367650210878196 "planes 5 mm apart"
EOD
$grey0_3 << EOD
26.072878 6.417599769735659 "planes 15 mm apart"
72.715193 2.2367650210878196 "planes 5 mm apart"
EOD
$all0_4 << EOD
293.011615 6.405319900047326 "planes 15 mm apart"
EOD
$grey0_4 << EOD
293.011615 6.405319900047326 "planes 15 mm apart"
EOD
$all0_5 << EOD
13.615739 0.20675565984478014 "edges of 2 mm"
4.891199 0.3666517614642404 "edges of 4 mm"
2.452429 0.7954425340882524 "edges of 8 mm"
EOD
$grey0_5 << EOD
13.615739 0.20675565984478014 "edges of 2 mm"
4.891199 0.3666517614642404 "edges of 4 mm"
2.452429 0.7954425340882524 "edges of 8 mm"
EOD
$all1_0 << EOD
2.930162 0.025936238265934726 "CPU"
12.167673 0.02593603067590106 "GL"
EOD
$grey1_0 << EOD
NaN NaN ""
EOD
$all1_1 << EOD
4.077636 6.202984683564714 "planes 15 mm apart"
6.499479 2.2048762968171434 "planes 5 mm apart"
21.3964 0.5102606810397988 "planes 1 mm apart"
EOD
$grey1_1 << EOD
4.077636 6.202984683564714 "planes 15 mm apart"
6.499479 2.2048762968171434 "planes 5 mm apart"
21.3964 0.5102606810397988 "planes 1 mm apart"
EOD
$all1_2 << EOD
14.903972 6.202984683564714 "planes 15 mm apart"
EOD
$grey1_2 << EOD
14.903972 6.202984683564714 "planes 15 mm apart"
EOD
$all1_3 << EOD
43.840717 6.202492429757415 "planes 15 mm apart"
121.776262 2.2030387844793116 "planes 5 mm apart"
EOD
$grey1_3 << EOD
43.840717 6.202492429757415 "planes 15 mm apart"
121.776262 2.2030387844793116 "planes 5 mm apart"
EOD
$all1_4 << EOD
632.694678 6.192794803283664 "planes 15 mm apart"
EOD
$grey1_4 << EOD
632.694678 6.192794803283664 "planes 15 mm apart"
EOD
$all1_5 << EOD
21.033257 0.22701659343812378 "edges of 2 mm"
8.550758 0.3986796917867054 "edges of 4 mm"
4.697456 0.7914416185139392 "edges of 8 mm"
EOD
$grey1_5 << EOD
21.033257 0.22701659343812378 "edges of 2 mm"
8.550758 0.3986796917867054 "edges of 4 mm"
4.697456 0.7914416185139392 "edges of 8 mm"
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
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, $all0_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plain plane sweep, CPU', $grey0_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_2 using 1:2:3 with labels center offset 0,1.6 tc rgb '#009E73' notitle, $all0_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'plane sweep, GL', $grey0_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_3 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#CC79A7' notitle, $all0_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'the paper''s sweep, GL', $grey0_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, $all0_5 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#56B4E9' title 'octree mesh', $grey0_5 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_5 using 1:2:3 with labels center offset 0,0.9 tc rgb '#56B4E9' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
set title 'Views of 640 x 480 from 8 cameras, 1280 x 720: run time against error'
plot $all1_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey1_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all1_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey1_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, $all1_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plain plane sweep, CPU', $grey1_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_2 using 1:2:3 with labels center offset 0,1.6 tc rgb '#009E73' notitle, $all1_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'plane sweep, GL', $grey1_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_3 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#CC79A7' notitle, $all1_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'the paper''s sweep, GL', $grey1_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, $all1_5 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#56B4E9' title 'octree mesh', $grey1_5 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_5 using 1:2:3 with labels center offset 0,0.9 tc rgb '#56B4E9' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
set terminal pngcairo size 1350,1680 font 'Sans,17'
set output 'view_methods.png'
set multiplot layout 2,1
set title 'Views of 640 x 480 from 3 cameras, 640 x 480: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, $all0_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plain plane sweep, CPU', $grey0_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_2 using 1:2:3 with labels center offset 0,1.6 tc rgb '#009E73' notitle, $all0_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'plane sweep, GL', $grey0_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_3 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#CC79A7' notitle, $all0_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'the paper''s sweep, GL', $grey0_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, $all0_5 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#56B4E9' title 'octree mesh', $grey0_5 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_5 using 1:2:3 with labels center offset 0,0.9 tc rgb '#56B4E9' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
set title 'Views of 640 x 480 from 8 cameras, 1280 x 720: run time against error'
plot $all1_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey1_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all1_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey1_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, $all1_2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plain plane sweep, CPU', $grey1_2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_2 using 1:2:3 with labels center offset 0,1.6 tc rgb '#009E73' notitle, $all1_3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'plane sweep, GL', $grey1_3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_3 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#CC79A7' notitle, $all1_4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'the paper''s sweep, GL', $grey1_4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_4 using 1:2:3 with labels right offset -0.9,-0.5 tc rgb '#E69F00' notitle, $all1_5 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#56B4E9' title 'octree mesh', $grey1_5 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1_5 using 1:2:3 with labels center offset 0,0.9 tc rgb '#56B4E9' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
