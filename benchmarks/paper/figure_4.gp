call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1400, 1000)
set output pictures . 'figure_4.png'
set multiplot layout 2,2 margins 0.125,0.98,0.07,0.955 spacing 0.115,0.11
set xlabel 't' offset 0,0.6
set ylabel 'H − H(0)' offset 1,0
set format y powers
set ytics add ('0' 0)
set key top center

set offsets 0, 0, graph 0.3, 0
file = data . 'figure_4_sweep.dat'
set title 'β and γ, equal'
set key horizontal maxrows 2
plot for [i = 0:blocks(file) - 1] file index i with lines lt i + 1 title name(file, i)

unset ylabel
file = data . 'figure_4_splittings.dat'
set title 'the midpoint rule and SABA2'
set key vertical maxrows auto
plot for [i = 0:blocks(file) - 1] file index i with lines lt i + 1 title name(file, i)

set ylabel 'H − H(0)' offset 1,0
file = data . 'figure_4_small.dat'
set title 'β and γ, equal and small'
plot for [i = 0:blocks(file) - 1] file index i with lines lt i + 1 title name(file, i)

set offsets 0, 0, 0, 0
file = data . 'figure_4_order.dat'
set title 'order of the energy error'
set logscale xy
set ytics autofreq
set format y '10^{%L}'
set format x '%g'
set xlabel 'h'
set ylabel 'max H − min H' offset 1,0
set key bottom right
set xrange [0.025:40]
set xtics (0.03, 0.1, 0.3, 1)
plot for [i = 0:blocks(file) - 1] file index i using 1:2 with linespoints lt i + 1 title name(file, i), \
     [0.03:1] 2e-2*x lt 9 dt 3 title 'h', [0.03:1] 2e-3*x**2 lt 9 dt 4 title 'h²'
unset multiplot
