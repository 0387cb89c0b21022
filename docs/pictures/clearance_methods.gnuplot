$all0_0 << EOD
17.816090624999998 1.0924920334247017 "edges of 8 mm"
75.68726129166666 0.7023002061507683 "edges of 4 mm"
336.3066925833334 0.32837304612192464 "edges of 2 mm"
EOD
$grey0_0 << EOD
17.816090624999998 1.0924920334247017 "edges of 8 mm"
75.68726129166666 0.7023002061507683 "edges of 4 mm"
336.3066925833334 0.32837304612192464 "edges of 2 mm"
EOD
$all0_1 << EOD
0.29171137499999994 3.9707662179155374 "10 mm"
0.20943533333333336 1.2625884264031255 "3 mm"
0.26471087499999996 0.30897726801468084 "1 mm"
0.34336070833333326 0.10579944554068725 "0.3 mm"
0.45994995833333335 0.03850712878167223 "0.1 mm"
0.6017202916666665 0.009131353769222701 "0.03 mm"
0.8024635 0.004227818202862261 "0.01 mm"
EOD
$grey0_1 << EOD
0.29171137499999994 3.9707662179155374 "10 mm"
EOD
set logscale xy
set grid lc rgb '#cccccc'
set border 3
set tics nomirror
set key bottom right Left reverse
set xlabel 'hull in memory to answer, one thread, ms'
set ylabel 'RMS error, mm'
set format xy '%g'
set offsets graph 0.08, graph 0.28, graph 0.15, graph 0.1
set terminal svg size 900,560 font 'Sans,15' background rgb 'white'
set output 'clearance_methods.svg'
set multiplot layout 1,1
set title 'Clearance of the panel, 5 to 60 mm: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'hull mesh and FCL', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'certified clearance', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
set terminal pngcairo size 1350,840 font 'Sans,17'
set output 'clearance_methods.png'
set multiplot layout 1,1
set title 'Clearance of the panel, 5 to 60 mm: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'hull mesh and FCL', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'certified clearance', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
