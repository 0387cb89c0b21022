$cells0 << EOD
-653.1 -304.8 11.38
-653.1 -101.6 11.12
-653.1 101.6 10.86
-653.1 304.8 10.71
-435.4 -304.8 19.86
-435.4 -101.6 11.13
-435.4 101.6 10.89
-435.4 304.8 10.71
-435.4 507.9 10.59
-217.7 -507.9 23.46
-217.7 -304.8 20.80
-217.7 -101.6 18.81
-217.7 101.6 10.81
-217.7 304.8 10.61
-217.7 507.9 10.50
0.0 -507.9 23.34
0.0 -304.8 17.40
0.0 -101.6 16.15
0.0 101.6 10.49
0.0 304.8 10.31
0.0 507.9 10.42
217.7 -507.9 30.97
217.7 -304.8 24.79
217.7 -101.6 18.99
217.7 101.6 11.09
217.7 304.8 10.92
217.7 507.9 10.79
435.4 -507.9 28.33
435.4 -304.8 22.05
435.4 -101.6 20.58
435.4 101.6 11.65
435.4 304.8 11.45
653.1 -507.9 18.19
653.1 -304.8 17.40
653.1 -101.6 16.41
EOD
$cells1 << EOD
-653.1 -304.8 11.23
-653.1 -101.6 10.28
-653.1 101.6 10.64
-653.1 304.8 10.10
-435.4 -304.8 18.26
-435.4 -101.6 14.81
-435.4 101.6 10.11
-435.4 304.8 10.07
-435.4 507.9 10.03
-217.7 -507.9 18.97
-217.7 -304.8 20.23
-217.7 -101.6 19.14
-217.7 101.6 10.23
-217.7 304.8 9.96
-217.7 507.9 9.91
0.0 -507.9 23.08
0.0 -304.8 19.46
0.0 -101.6 16.25
0.0 101.6 10.69
0.0 304.8 9.50
0.0 507.9 9.60
217.7 -507.9 24.84
217.7 -304.8 19.76
217.7 -101.6 14.96
217.7 101.6 11.24
217.7 304.8 10.08
217.7 507.9 9.59
435.4 -507.9 22.96
435.4 -304.8 21.64
435.4 -101.6 17.01
435.4 101.6 11.18
435.4 304.8 10.15
653.1 -507.9 22.26
653.1 -304.8 18.24
653.1 -101.6 15.19
EOD
$cells2 << EOD
-653.1 -304.8 8.33
-653.1 -101.6 8.95
-653.1 101.6 9.26
-653.1 304.8 8.25
-435.4 -304.8 13.72
-435.4 -101.6 9.43
-435.4 101.6 9.41
-435.4 304.8 7.09
-435.4 507.9 9.48
-217.7 -507.9 10.55
-217.7 -304.8 11.36
-217.7 -101.6 11.73
-217.7 101.6 9.83
-217.7 304.8 8.71
-217.7 507.9 9.12
0.0 -507.9 10.66
0.0 -304.8 10.91
0.0 -101.6 12.44
0.0 101.6 9.14
0.0 304.8 6.44
0.0 507.9 8.96
217.7 -507.9 7.92
217.7 -304.8 8.70
217.7 -101.6 8.77
217.7 101.6 8.06
217.7 304.8 6.71
217.7 507.9 8.74
435.4 -507.9 9.49
435.4 -304.8 11.13
435.4 -101.6 9.06
435.4 101.6 7.25
435.4 304.8 6.52
653.1 -507.9 9.85
653.1 -304.8 12.94
653.1 -101.6 7.72
EOD
set xrange [-762.0:762.0]
set yrange [-609.5:609.5]
set size ratio -1
unset key
set object 1 rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb '#cccccc' fillstyle solid noborder
set palette defined (0 '#b2182b', 5 '#f4a582', 10 '#f7f7f7', 15 '#92c5de', 25 '#2166ac')
set cbrange [0:25]
set cblabel 'width, mm'
set tics nomirror
set xtics 500
set ytics 500
set xlabel 'x, mm (the participant stands below)'
set ylabel 'y, mm'
set terminal svg size 1440,360 font 'Sans,12' background rgb 'white'
set output 'finger_width.svg'
set multiplot layout 1,3
set title 'hull of perfect cameras'
plot $cells0 using 1:2:(108.9):(101.6):3 with boxxyerror fillstyle solid noborder lc palette notitle, $cells0 using 1:2:(sprintf('%.0f', $3)) with labels tc rgb '#000000' notitle
set title 'hull, the errors all together'
plot $cells1 using 1:2:(108.9):(101.6):3 with boxxyerror fillstyle solid noborder lc palette notitle, $cells1 using 1:2:(sprintf('%.0f', $3)) with labels tc rgb '#000000' notitle
set title 'the same on planes 15 mm apart'
plot $cells2 using 1:2:(108.9):(101.6):3 with boxxyerror fillstyle solid noborder lc palette notitle, $cells2 using 1:2:(sprintf('%.0f', $3)) with labels tc rgb '#000000' notitle
unset multiplot
set terminal pngcairo size 2160,540 font 'Sans,14'
set output 'finger_width.png'
set multiplot layout 1,3
set title 'hull of perfect cameras'
plot $cells0 using 1:2:(108.9):(101.6):3 with boxxyerror fillstyle solid noborder lc palette notitle, $cells0 using 1:2:(sprintf('%.0f', $3)) with labels tc rgb '#000000' notitle
set title 'hull, the errors all together'
plot $cells1 using 1:2:(108.9):(101.6):3 with boxxyerror fillstyle solid noborder lc palette notitle, $cells1 using 1:2:(sprintf('%.0f', $3)) with labels tc rgb '#000000' notitle
set title 'the same on planes 15 mm apart'
plot $cells2 using 1:2:(108.9):(101.6):3 with boxxyerror fillstyle solid noborder lc palette notitle, $cells2 using 1:2:(sprintf('%.0f', $3)) with labels tc rgb '#000000' notitle
unset multiplot
