$all0_0 << EOD
0.5305507916666666 19.671616849797037 "5 x 5"
1.6473527499999998 11.202784554230366 "10 x 10"
5.783602583333333 5.451918790730465 "20 x 20"
21.7497345 2.5545462177167626 "40 x 40"
85.85571041666668 1.3114822881632187 "80 x 80"
EOD
$grey0_0 << EOD
0.5305507916666666 19.671616849797037 "5 x 5"
1.6473527499999998 11.202784554230366 "10 x 10"
5.783602583333333 5.451918790730465 "20 x 20"
21.7497345 2.5545462177167626 "40 x 40"
85.85571041666668 1.3114822881632187 "80 x 80"
EOD
$all0_1 << EOD
0.273781875 10.7037268342827 "8 mm"
0.30141687500000003 2.8885373493495754 "4 mm"
0.3096063333333333 0.924829365022511 "2 mm"
0.4023435833333333 0.8237977570772514 "half a pixel"
1.3181865416666667 0.10068950055280398 "0.25 mm"
2.47989625 0.1491691564338407 "0.125 mm"
EOD
$grey0_1 << EOD
2.47989625 0.1491691564338407 "0.125 mm"
EOD
set logscale xy
set grid lc rgb '#cccccc'
set border 3
set tics nomirror
set key bottom right Left reverse
set xlabel 'hull in memory to answer, one thread, ms'
set ylabel 'RMS error of the contact area, %'
set format xy '%g'
set offsets graph 0.08, graph 0.28, graph 0.15, graph 0.1
set terminal svg size 900,560 font 'Sans,15' background rgb 'white'
set output 'contact_methods.svg'
set multiplot layout 1,1
set title 'Contacts of a curtain of 720 triangles: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'the paper''s viewports, CPU', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'exact contacts', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
set terminal pngcairo size 1350,840 font 'Sans,17'
set output 'contact_methods.png'
set multiplot layout 1,1
set title 'Contacts of a curtain of 720 triangles: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'the paper''s viewports, CPU', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'exact contacts', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left offset 0.9,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
