# Drawn by: gnuplot THIS_FILE
set terminal pngcairo size 2400,880 enhanced font 'Sans,11' background rgb 'white' fontscale 1.7 linewidth 2 pointscale 2
set output '/tmp/wt/bench/.xdg/p.png'
set border 3 lc rgb '#555555'
set tics nomirror out scale 0.6
set grid lc rgb '#DDDDDD' lw 0.6 dt 1
set samples 2
$data_0_0 << EOD
4.43792703e-08 0.00322418126
8.17765975e-08 0.00161065413
1.57013516e-07 0.000802362154
3.07422273e-07 0.000400530805
6.05947059e-07 0.000200102795
1.20363294e-06 0.000100009373
2.40044778e-06 4.99942304e-05
4.805936e-06 2.49945004e-05
EOD
$data_0_1 << EOD
1.1806824e-07 9.59832747e-05
1.72419425e-07 2.39825557e-05
2.64168036e-07 5.99473862e-06
5.20197931e-07 1.49872536e-06
1.04114467e-06 3.74677053e-07
2.15266857e-06 9.36689928e-08
4.3521175e-06 2.34172313e-08
8.880515e-06 5.85430842e-09
0.00028706821 5.94895314e-12
EOD
$data_1_0 << EOD
4.43792703e-08 0.0459693897
8.17765975e-08 0.0255983439
1.57013516e-07 0.0134789426
3.07422273e-07 0.0069129052
6.05947059e-07 0.00350026053
1.20363294e-06 0.00176113927
2.40044778e-06 0.000883329064
4.805936e-06 0.000442355291
EOD
$data_1_1 << EOD
1.1806824e-07 0.0150785624
1.72419425e-07 0.00378684103
2.64168036e-07 0.000947787416
5.20197931e-07 0.00023701421
1.04114467e-06 5.92577626e-05
2.15266857e-06 1.48147038e-05
4.3521175e-06 3.7036924e-06
8.880515e-06 9.25924132e-07
0.00028706821 9.40886433e-10
EOD
set multiplot layout 1,2

set title 'pendulum: energy error' noenhanced
set xlabel 'run time for a unit of time [s]' noenhanced
set ylabel 'max |H - H(0)|' noenhanced
set logscale x
set format x '10^{%L}'
set xtics autofreq
set xtics autofreq
set xrange [2.77370439e-08:0.000459309136]
set logscale y
set format y '10^{%L}'
set xtics autofreq
set ytics 100
set yrange [3.71809571e-12:0.00515869001]
set size noratio
set rmargin 20.099999999999998
unset label
set label 'implicit-midpoint' at graph 1.02, graph 0.0223 noenhanced textcolor rgb '#D55E00'
set label 'symplectic-euler-a' at graph 1.02, graph 0.7468 noenhanced textcolor rgb '#0072B2'
plot $data_0_0 using 1:2 notitle with linespoints lc rgb '#0072B2' lw 1.6 dt 1 pt 7 ps 0.7, \
     $data_0_1 using 1:2 notitle with linespoints lc rgb '#D55E00' lw 1.6 dt 2 pt 5 ps 0.7

set title 'pendulum: state error' noenhanced
set xlabel 'run time for a unit of time [s]' noenhanced
set ylabel '|z - z*| at t = 100' noenhanced
set logscale x
set format x '10^{%L}'
set xtics autofreq
set xtics autofreq
set xrange [2.77370439e-08:0.000459309136]
set logscale y
set format y '10^{%L}'
set xtics autofreq
set ytics 100
set yrange [5.88054021e-10:0.0735510235]
set size noratio
set rmargin 20.099999999999998
unset label
set label 'implicit-midpoint' at graph 1.02, graph 0.0252 noenhanced textcolor rgb '#D55E00'
set label 'symplectic-euler-a' at graph 1.02, graph 0.7257 noenhanced textcolor rgb '#0072B2'
plot $data_1_0 using 1:2 notitle with linespoints lc rgb '#0072B2' lw 1.6 dt 1 pt 7 ps 0.7, \
     $data_1_1 using 1:2 notitle with linespoints lc rgb '#D55E00' lw 1.6 dt 2 pt 5 ps 0.7
unset multiplot
unset output
