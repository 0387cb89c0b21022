$shares0_0 << EOD
-9.5 0.00 0.00 0.00 100.00
-8.5 0.00 0.00 0.00 100.00
-7.5 0.00 0.00 0.00 100.00
-6.5 0.00 0.00 0.00 100.00
-5.5 0.00 0.00 0.00 100.00
-4.5 0.00 0.00 0.00 100.00
-3.5 0.47 0.47 0.47 100.00
-2.5 0.00 0.00 0.00 100.00
-1.5 0.28 0.56 0.56 100.00
-0.5 0.00 0.85 0.88 100.00
0.5 0.23 29.82 30.50 100.00
1.5 0.00 55.70 55.70 100.00
2.5 1.75 63.82 64.04 100.00
3.5 13.08 74.05 74.05 100.00
4.5 21.63 79.17 79.37 100.00
5.5 32.91 85.77 85.77 100.00
6.5 37.99 82.87 83.07 100.00
7.5 49.67 88.52 88.52 100.00
8.5 51.52 91.31 91.31 100.00
9.5 59.69 91.07 91.07 100.00
10.5 64.73 93.30 93.53 100.00
11.5 74.73 96.11 96.11 100.00
12.5 75.46 94.91 94.91 100.00
13.5 81.84 94.81 94.81 100.00
14.5 85.39 96.58 96.58 100.00
15.5 84.76 95.61 95.61 100.00
16.5 85.65 95.93 95.93 100.00
17.5 88.43 95.90 95.90 100.00
18.5 87.80 94.88 94.88 100.00
19.5 89.93 96.56 96.56 100.00
20.5 91.03 96.32 96.32 100.00
21.5 94.01 97.34 97.34 100.00
22.5 93.30 98.38 98.38 100.00
23.5 95.51 98.58 98.58 100.00
24.5 96.33 98.17 98.17 100.00
25.5 96.21 99.24 99.24 100.00
26.5 96.20 98.37 98.37 100.00
27.5 97.18 99.15 99.15 100.00
28.5 97.32 99.40 99.40 100.00
29.5 96.96 98.99 98.99 100.00
30.5 96.68 100.00 100.00 100.00
31.5 97.08 99.68 99.68 100.00
32.5 98.97 99.66 99.66 100.00
33.5 99.44 100.00 100.00 100.00
34.5 98.56 99.71 99.71 100.00
35.5 99.64 100.00 100.00 100.00
36.5 99.23 99.61 99.61 100.00
37.5 98.73 100.00 100.00 100.00
38.5 99.28 100.00 100.00 100.00
39.5 99.67 100.00 100.00 100.00
EOD
$shares0_1 << EOD
-9.5 0.00 0.00 0.00 100.00
-8.5 0.00 0.00 0.00 100.00
-7.5 0.00 0.00 0.00 100.00
-6.5 0.00 0.00 0.00 100.00
-5.5 0.00 0.00 0.00 100.00
-4.5 0.00 0.00 0.00 100.00
-3.5 0.00 0.00 0.00 100.00
-2.5 0.27 0.80 0.80 100.00
-1.5 0.56 1.96 1.96 100.00
-0.5 0.23 1.65 1.65 100.00
0.5 0.23 40.41 40.64 100.00
1.5 0.41 68.79 69.20 100.00
2.5 2.26 80.09 80.09 100.00
3.5 11.39 82.70 82.70 100.00
4.5 21.03 84.74 84.74 100.00
5.5 25.55 88.93 88.93 100.00
6.5 37.50 92.21 92.21 100.00
7.5 48.12 96.03 96.03 100.00
8.5 60.00 96.77 96.77 100.00
9.5 70.54 98.49 98.49 100.00
10.5 73.74 96.12 96.12 100.00
11.5 77.85 97.85 97.85 100.00
12.5 78.72 97.64 97.64 100.00
13.5 80.95 97.38 97.38 100.00
14.5 88.54 99.15 99.15 100.00
15.5 90.51 99.03 99.03 100.00
16.5 92.68 99.51 99.51 100.00
17.5 93.25 99.52 99.52 100.00
18.5 93.76 98.08 98.08 100.00
19.5 94.67 99.24 99.24 100.00
20.5 96.32 100.00 100.00 100.00
21.5 96.50 99.56 99.56 100.00
22.5 96.99 99.77 99.77 100.00
23.5 98.42 100.00 100.00 100.00
24.5 98.85 99.77 99.77 100.00
25.5 98.94 100.00 100.00 100.00
26.5 97.57 100.00 100.00 100.00
27.5 98.34 100.00 100.00 100.00
28.5 98.85 100.00 100.00 100.00
29.5 98.91 100.00 100.00 100.00
30.5 97.77 100.00 100.00 100.00
31.5 99.35 100.00 100.00 100.00
32.5 99.34 100.00 100.00 100.00
33.5 99.44 100.00 100.00 100.00
34.5 98.80 100.00 100.00 100.00
35.5 99.30 100.00 100.00 100.00
36.5 99.63 100.00 100.00 100.00
37.5 99.34 100.00 100.00 100.00
38.5 99.31 100.00 100.00 100.00
39.5 100.00 100.00 100.00 100.00
EOD
$shares0_2 << EOD
-9.5 0.00 0.00 0.00 100.00
-8.5 0.00 0.00 0.00 100.00
-7.5 0.00 0.00 0.00 100.00
-6.5 0.54 0.54 0.54 100.00
-5.5 0.31 0.31 0.31 100.00
-4.5 0.00 0.00 0.00 100.00
-3.5 0.43 0.64 0.64 100.00
-2.5 0.53 2.94 2.94 100.00
-1.5 0.29 4.32 4.32 100.00
-0.5 0.00 3.09 3.12 100.00
0.5 0.23 67.75 68.91 100.00
1.5 0.21 89.38 89.58 100.00
2.5 1.79 93.74 93.74 100.00
3.5 13.46 98.08 98.08 100.00
4.5 30.06 98.20 98.20 100.00
5.5 40.97 99.16 99.16 100.00
6.5 53.48 99.59 99.59 100.00
7.5 67.25 99.57 99.57 100.00
8.5 76.42 99.59 99.59 100.00
9.5 85.78 100.00 100.00 100.00
10.5 82.90 99.78 99.78 100.00
11.5 89.28 100.00 100.00 100.00
12.5 91.10 99.30 99.30 100.00
13.5 92.94 99.53 99.53 100.00
14.5 94.37 99.78 99.78 100.00
15.5 94.96 100.00 100.00 100.00
16.5 96.83 99.51 99.51 100.00
17.5 97.13 100.00 100.00 100.00
18.5 95.84 99.76 99.76 100.00
19.5 96.80 99.75 99.75 100.00
20.5 98.61 100.00 100.00 100.00
21.5 98.03 99.56 99.56 100.00
22.5 98.10 100.00 100.00 100.00
23.5 98.61 100.00 100.00 100.00
24.5 99.55 100.00 100.00 100.00
25.5 99.24 100.00 100.00 100.00
26.5 99.15 100.00 100.00 100.00
27.5 98.90 100.00 100.00 100.00
28.5 99.43 100.00 100.00 100.00
29.5 100.00 100.00 100.00 100.00
30.5 100.00 100.00 100.00 100.00
31.5 99.68 100.00 100.00 100.00
32.5 100.00 100.00 100.00 100.00
33.5 99.72 100.00 100.00 100.00
34.5 99.70 100.00 100.00 100.00
35.5 100.00 100.00 100.00 100.00
36.5 99.63 100.00 100.00 100.00
37.5 100.00 100.00 100.00 100.00
38.5 100.00 100.00 100.00 100.00
39.5 99.64 100.00 100.00 100.00
EOD
$shares1_0 << EOD
-9.5 0.00 0.00 0.00 100.00
-8.5 0.00 0.00 0.00 100.00
-7.5 0.00 0.00 0.00 100.00
-6.5 0.00 0.00 0.00 100.00
-5.5 0.00 0.00 0.00 100.00
-4.5 0.00 0.00 0.00 100.00
-3.5 0.47 0.47 0.47 100.00
-2.5 0.00 0.00 0.00 100.00
-1.5 0.28 0.56 0.56 100.00
-0.5 0.00 0.04 0.88 100.00
0.5 0.23 0.92 30.50 100.00
1.5 0.00 1.90 55.70 100.00
2.5 0.00 1.32 64.04 100.00
3.5 0.00 3.38 74.05 100.00
4.5 0.20 2.98 79.37 100.00
5.5 0.00 4.46 85.77 100.00
6.5 0.00 8.86 83.07 100.00
7.5 0.00 14.35 88.52 100.00
8.5 0.00 28.69 91.31 100.00
9.5 0.00 45.53 91.07 100.00
10.5 0.00 63.84 93.53 100.00
11.5 0.00 72.35 96.11 100.00
12.5 0.00 74.31 94.91 100.00
13.5 0.47 80.66 94.58 100.00
14.5 3.20 85.39 96.58 100.00
15.5 12.01 86.61 95.61 100.00
16.5 26.56 87.32 95.93 100.00
17.5 32.29 89.88 95.90 100.00
18.5 36.59 90.49 94.88 100.00
19.5 46.44 91.65 96.56 100.00
20.5 52.64 92.18 96.32 100.00
21.5 64.75 95.57 97.34 100.00
22.5 63.05 97.23 98.38 100.00
23.5 69.50 97.87 98.58 100.00
24.5 74.08 97.71 98.17 100.00
25.5 76.52 98.23 99.24 100.00
26.5 80.98 97.55 98.37 100.00
27.5 85.88 98.59 99.15 100.00
28.5 83.33 98.21 99.40 100.00
29.5 88.51 98.65 98.99 100.00
30.5 88.70 98.01 100.00 100.00
31.5 87.99 97.73 99.68 100.00
32.5 92.10 99.31 99.66 100.00
33.5 92.50 99.44 100.00 100.00
34.5 89.91 99.42 99.71 100.00
35.5 94.18 100.00 100.00 100.00
36.5 93.82 99.23 99.61 100.00
37.5 93.95 99.36 100.00 100.00
38.5 92.83 100.00 100.00 100.00
39.5 94.43 100.00 100.00 100.00
EOD
$shares1_1 << EOD
-9.5 0.00 0.00 0.00 100.00
-8.5 0.00 0.00 0.00 100.00
-7.5 0.00 0.00 0.00 100.00
-6.5 0.00 0.00 0.00 100.00
-5.5 0.00 0.00 0.00 100.00
-4.5 0.00 0.00 0.00 100.00
-3.5 0.00 0.00 0.00 100.00
-2.5 0.27 0.53 0.80 100.00
-1.5 0.56 1.96 1.96 100.00
-0.5 0.23 0.38 1.65 100.00
0.5 0.23 2.51 40.64 100.00
1.5 0.41 2.87 69.20 100.00
2.5 0.45 6.11 80.09 100.00
3.5 0.21 5.70 82.70 100.00
4.5 0.21 5.98 84.74 100.00
5.5 0.40 10.06 88.93 100.00
6.5 0.00 17.83 92.21 100.00
7.5 0.00 23.18 96.03 100.00
8.5 0.00 40.81 96.77 100.00
9.5 0.00 63.01 98.49 100.00
10.5 0.23 76.26 96.12 100.00
11.5 0.00 83.01 97.85 100.00
12.5 0.00 87.00 97.64 100.00
13.5 0.24 88.57 97.38 100.00
14.5 2.34 94.48 99.15 100.00
15.5 13.14 95.38 99.03 100.00
16.5 29.02 96.59 99.51 100.00
17.5 39.28 96.63 99.52 100.00
18.5 49.16 96.64 98.08 100.00
19.5 59.14 97.97 99.24 100.00
20.5 65.75 98.85 100.00 100.00
21.5 72.87 98.47 99.56 100.00
22.5 82.64 99.54 99.77 100.00
23.5 83.78 99.77 100.00 100.00
24.5 85.25 99.31 99.77 100.00
25.5 87.86 99.47 100.00 100.00
26.5 86.22 100.00 100.00 100.00
27.5 86.98 99.72 100.00 100.00
28.5 86.74 100.00 100.00 100.00
29.5 91.30 100.00 100.00 100.00
30.5 92.04 99.68 100.00 100.00
31.5 93.83 100.00 100.00 100.00
32.5 91.69 100.00 100.00 100.00
33.5 96.91 100.00 100.00 100.00
34.5 94.91 100.00 100.00 100.00
35.5 94.74 100.00 100.00 100.00
36.5 92.59 100.00 100.00 100.00
37.5 95.38 100.00 100.00 100.00
38.5 97.22 100.00 100.00 100.00
39.5 97.18 100.00 100.00 100.00
EOD
$shares1_2 << EOD
-9.5 0.00 0.00 0.00 100.00
-8.5 0.00 0.00 0.00 100.00
-7.5 0.00 0.00 0.00 100.00
-6.5 0.54 0.54 0.54 100.00
-5.5 0.31 0.31 0.31 100.00
-4.5 0.00 0.00 0.00 100.00
-3.5 0.43 0.60 0.64 100.00
-2.5 0.53 2.41 2.94 100.00
-1.5 0.29 2.31 4.32 100.00
-0.5 0.00 0.72 3.09 100.00
0.5 0.23 6.26 68.91 100.00
1.5 0.21 8.96 89.58 100.00
2.5 0.22 11.86 93.74 100.00
3.5 0.21 14.53 98.08 100.00
4.5 0.20 14.63 98.20 100.00
5.5 0.00 19.96 99.16 100.00
6.5 0.20 32.17 99.59 100.00
7.5 0.00 44.47 99.57 100.00
8.5 0.00 61.38 99.59 100.00
9.5 0.00 82.17 100.00 100.00
10.5 0.00 95.89 99.78 100.00
11.5 0.44 98.03 100.00 100.00
12.5 0.00 97.89 99.30 100.00
13.5 0.24 99.29 99.53 100.00
14.5 3.68 99.57 99.78 100.00
15.5 18.71 99.28 100.00 100.00
16.5 48.05 99.51 99.51 100.00
17.5 60.29 100.00 100.00 100.00
18.5 74.82 99.51 99.76 100.00
19.5 78.57 99.75 99.75 100.00
20.5 85.91 99.77 100.00 100.00
21.5 88.16 99.34 99.56 100.00
22.5 90.48 100.00 100.00 100.00
23.5 93.97 100.00 100.00 100.00
24.5 94.16 100.00 100.00 100.00
25.5 94.95 99.49 100.00 100.00
26.5 96.88 100.00 100.00 100.00
27.5 96.43 100.00 100.00 100.00
28.5 95.69 100.00 100.00 100.00
29.5 97.26 100.00 100.00 100.00
30.5 98.03 100.00 100.00 100.00
31.5 97.42 100.00 100.00 100.00
32.5 98.95 100.00 100.00 100.00
33.5 99.17 100.00 100.00 100.00
34.5 97.92 100.00 100.00 100.00
35.5 98.28 100.00 100.00 100.00
36.5 99.25 100.00 100.00 100.00
37.5 99.00 100.00 100.00 100.00
38.5 99.66 100.00 100.00 100.00
39.5 99.28 100.00 100.00 100.00
EOD
set xrange [-10:40]
set yrange [0:100]
set boxwidth 1.04
set border 3
set tics nomirror out
set xtics 10
set ytics 25
set xlabel 'true distance, mm (below 0: overlap)'
set ylabel 'share, %'
set key inside bottom right opaque box samplen 1.5
set bmargin 3.5
set arrow 1 from 0,0 to 0,100 nohead front lw 1.5 lc rgb '#000000'
set terminal svg size 1260,680 font 'Sans,13' background rgb 'white'
set output 'verdict_words.svg'
set multiplot layout 2,3
set title '3 cameras, 1 mm required'
plot $shares0_0 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares0_0 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares0_0 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares0_0 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '4 cameras, 1 mm required'
plot $shares0_1 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares0_1 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares0_1 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares0_1 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '8 cameras, 1 mm required'
plot $shares0_2 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares0_2 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares0_2 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares0_2 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '3 cameras, 10 mm required'
plot $shares1_0 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares1_0 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares1_0 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares1_0 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '4 cameras, 10 mm required'
plot $shares1_1 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares1_1 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares1_1 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares1_1 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '8 cameras, 10 mm required'
plot $shares1_2 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares1_2 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares1_2 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares1_2 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
unset multiplot
set terminal pngcairo size 1890,1020 font 'Sans,15'
set output 'verdict_words.png'
set multiplot layout 2,3
set title '3 cameras, 1 mm required'
plot $shares0_0 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares0_0 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares0_0 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares0_0 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '4 cameras, 1 mm required'
plot $shares0_1 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares0_1 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares0_1 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares0_1 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '8 cameras, 1 mm required'
plot $shares0_2 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares0_2 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares0_2 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares0_2 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '3 cameras, 10 mm required'
plot $shares1_0 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares1_0 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares1_0 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares1_0 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '4 cameras, 10 mm required'
plot $shares1_1 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares1_1 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares1_1 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares1_1 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
set title '8 cameras, 10 mm required'
plot $shares1_2 using 1:5 with boxes fillstyle solid noborder lc rgb '#D55E00' title 'contact', $shares1_2 using 1:4 with boxes fillstyle solid noborder lc rgb '#E69F00' title 'near', $shares1_2 using 1:3 with boxes fillstyle solid noborder lc rgb '#c8c8c8' title 'undecided', $shares1_2 using 1:2 with boxes fillstyle solid noborder lc rgb '#009E73' title 'clear'
unset multiplot
