$all0_0 << EOD
28.57837533333333 1.0925352513758713 "edges of 8 mm"
119.87881220833334 0.7022946570369175 "edges of 4 mm"
532.1580899166667 0.3283752446701914 "edges of 2 mm"
EOD
$grey0_0 << EOD
28.57837533333333 1.0925352513758713 "edges of 8 mm"
119.87881220833334 0.7022946570369175 "edges of 4 mm"
532.1580899166667 0.3283752446701914 "edges of 2 mm"
EOD
$all0_1 << EOD
0.2615631666666666 4.257011493551224 "10 mm"
0.36794470833333337 0.7946650440054259 "3 mm"
0.49814733333333333 0.4084679300615461 "1 mm"
0.6886752083333332 0.10671708995725131 "0.3 mm"
0.9104868333333334 0.039233794163581026 "0.1 mm"
1.2229053333333337 0.010233678450743475 "0.03 mm"
1.5721914166666666 0.0031823703245731022 "0.01 mm"
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
set title 'Clearance of the curtain, 5 to 60 mm: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'hull mesh and FCL', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'certified clearance', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
set terminal pngcairo size 1350,840 font 'Sans,17'
set output 'clearance_methods.png'
set multiplot layout 1,1
set title 'Clearance of the curtain, 5 to 60 mm: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'hull mesh and FCL', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'certified clearance', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
