$all0 << EOD
1.276188 3.110487184156514e-05 "CPU"
6.715563 3.456495934914582e-05 "GL"
EOD
$grey0 << EOD
6.715563 3.456495934914582e-05 "GL"
EOD
$all1 << EOD
3.19741 6.4196256297815735 "planes 15 mm apart"
5.702876 2.238645512054733 "planes 5 mm apart"
20.031752 0.47912261597162503 "planes 1 mm apart"
EOD
$grey1 << EOD
3.19741 6.4196256297815735 "planes 15 mm apart"
5.702876 2.238645512054733 "planes 5 mm apart"
20.031752 0.47912261597162503 "planes 1 mm apart"
EOD
$all2 << EOD
40.306193 6.417599769735659 "planes 15 mm apart"
112.483169 2.2367650210878196 "planes 5 mm apart"
EOD
$grey2 << EOD
40.306193 6.417599769735659 "planes 15 mm apart"
112.483169 2.2367650210878196 "planes 5 mm apart"
EOD
$all3 << EOD
551.248256 6.326158033929101 "planes 15 mm apart"
EOD
$grey3 << EOD
551.248256 6.326158033929101 "planes 15 mm apart"
EOD
$all4 << EOD
17.64529 0.20675565984478014 "edges of 2 mm"
6.981954 0.3666517614642404 "edges of 4 mm"
3.941505 0.7954425340882524 "edges of 8 mm"
EOD
$grey4 << EOD
17.64529 0.20675565984478014 "edges of 2 mm"
6.981954 0.3666517614642404 "edges of 4 mm"
3.941505 0.7954425340882524 "edges of 8 mm"
EOD
set logscale xy
set grid lc rgb '#cccccc'
set border 3
set tics nomirror
set key center right Left reverse
set title 'Views of 640 x 480, three cameras: run time against error'
set xlabel 'masks in memory to depth, one thread, ms (median)'
set ylabel 'RMS distance to the hull of the masks, mm'
set format xy '%g'
set offsets graph 0.08, graph 0.3, graph 0.1, graph 0.1
set terminal svg size 900,620 font 'Sans,15' background rgb 'white'
set output 'view_methods.svg'
plot $all0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'exact view', $grey0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0 using 1:2:3 with labels left offset 0.9,0 tc rgb '#0072B2' notitle, $all1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'plane sweep, CPU', $grey1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1 using 1:2:3 with labels center offset 0,0.9 tc rgb '#D55E00' notitle, $all2 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#009E73' title 'plane sweep, GL', $grey2 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all2 using 1:2:3 with labels left offset 0.9,0 tc rgb '#009E73' notitle, $all3 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#CC79A7' title 'the paper''s sweep, GL', $grey3 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all3 using 1:2:3 with labels center offset 0,0.9 tc rgb '#CC79A7' notitle, $all4 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#E69F00' title 'octree mesh', $grey4 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all4 using 1:2:3 with labels center offset 0,-0.9 tc rgb '#E69F00' notitle
set terminal pngcairo size 1350,930 font 'Sans,17'
set output 'view_methods.png'
replot
