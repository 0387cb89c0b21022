$all0_0 << EOD
20.302204708333335 1.0925352513758693 "edges of 8 mm"
83.13859629166669 0.7022946570369181 "edges of 4 mm"
374.93181187500005 0.3283752446701928 "edges of 2 mm"
EOD
$grey0_0 << EOD
20.302204708333335 1.0925352513758693 "edges of 8 mm"
83.13859629166669 0.7022946570369181 "edges of 4 mm"
374.93181187500005 0.3283752446701928 "edges of 2 mm"
EOD
$all0_1 << EOD
0.2220347916666667 4.257011493551225 "10 mm"
0.2641434166666667 0.7821420435671633 "3 mm"
0.34901474999999993 0.4084679300615471 "1 mm"
0.4629970833333333 0.10671708995725147 "0.3 mm"
0.6135037500000001 0.03923379416358326 "0.1 mm"
0.8189135833333333 0.01023367845074474 "0.03 mm"
1.0855148333333335 0.003182370324574231 "0.01 mm"
EOD
$grey0_1 << EOD
NaN NaN ""
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
