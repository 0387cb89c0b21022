$all0 << EOD
319 0.0131 "steps of 0.05 mm"
310 0.0749 "steps of 0.25 mm"
280 0.149 "steps of 1 mm"
271 0.358 "steps of 4 mm"
EOD
$grey0 << EOD
NaN NaN ""
EOD
$all1 << EOD
1510 0.258 "edges of 2 mm"
424 0.406 "edges of 4 mm"
129 0.622 "edges of 8 mm"
EOD
$grey1 << EOD
1510 0.258 "edges of 2 mm"
424 0.406 "edges of 4 mm"
EOD
set logscale xy
set grid lc rgb '#cccccc'
set border 3
set tics nomirror
set key bottom left Left reverse
set title 'Views of 640 x 480, three cameras: run time against error'
set xlabel 'masks in memory to depth, one thread, ms (median)'
set ylabel 'RMS distance to the hull of the masks, mm'
set format xy '%g'
set offsets graph 0.08, graph 0.22, graph 0.1, graph 0.1
set terminal svg size 900,620 font 'Sans,15' background rgb 'white'
set output 'view_methods.svg'
plot $all0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'sphere tracing', $grey0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0 using 1:2:3 with labels left offset 0.9,0 tc rgb '#0072B2' notitle, $all1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'octree mesh', $grey1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all1 using 1:2:3 with labels center offset 0,0.9 tc rgb '#D55E00' notitle
set terminal pngcairo size 1350,930 font 'Sans,17'
set output 'view_methods.png'
replot
