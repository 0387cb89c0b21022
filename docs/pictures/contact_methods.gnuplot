$all0_0 << EOD
0.3727787083333332 20.004309506313373 "5 x 5"
1.1669547916666667 11.276664608546648 "10 x 10"
4.155663416666666 5.480532899463306 "20 x 20"
15.70588433333333 2.5564135927115945 "40 x 40"
60.769190166666675 1.3124601155147575 "80 x 80"
EOD
$grey0_0 << EOD
0.3727787083333332 20.004309506313373 "5 x 5"
1.1669547916666667 11.276664608546648 "10 x 10"
4.155663416666666 5.480532899463306 "20 x 20"
15.70588433333333 2.5564135927115945 "40 x 40"
60.769190166666675 1.3124601155147575 "80 x 80"
EOD
$all0_1 << EOD
0.17529566666666668 10.7037268342827 "8 mm"
0.22437162499999996 2.888537349349571 "4 mm"
0.22851566666666667 0.9248293650225103 "2 mm"
0.2947815833333334 0.8237977570772529 "half a pixel"
0.9503427916666667 0.10068950055280533 "0.25 mm"
1.7803628333333334 0.14916915643384235 "0.125 mm"
EOD
$grey0_1 << EOD
1.7803628333333334 0.14916915643384235 "0.125 mm"
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
set title 'Contacts of a panel of 720 triangles: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'the paper''s viewports, CPU', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'exact contacts', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
set terminal pngcairo size 1350,840 font 'Sans,17'
set output 'contact_methods.png'
set multiplot layout 1,1
set title 'Contacts of a panel of 720 triangles: run time against error'
plot $all0_0 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#0072B2' title 'the paper''s viewports, CPU', $grey0_0 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_0 using 1:2:3 with labels center offset 0,0.9 tc rgb '#0072B2' notitle, $all0_1 using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '#D55E00' title 'exact contacts', $grey0_1 using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, $all0_1 using 1:2:3 with labels left rotate by 25 offset 0.7,0.5 tc rgb '#D55E00' notitle, NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'
unset multiplot
