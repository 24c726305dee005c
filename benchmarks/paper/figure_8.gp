call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1400, 800)
set output pictures . 'figure_8.png'
set multiplot layout 1,2 margins 0.07,0.98,0.33,0.94 spacing 0.11
E = -0.03*cos(3.1)
law = data . 'figure_8_law.dat'
set title 'the best pairs'
set xlabel 'h'
set key at screen 0.07,0.22 left top Left reverse maxrows 2
set xrange [0:1.05]
plot law using 1:(1e3*$2) with points lt 1 title '1000 β', -1e3*x*E/12 lt 1 title '−1000 h E/12', \
     law using 1:(10*$3) with points lt 2 title '10 γ', -10*x/12 lt 2 title '−10 h/12'
file = data . 'figure_8_order.dat'
set title 'spread of the energy error'
set logscale xy
set xrange [0.005:1.3]
set xtics (0.01, 0.03, 0.1, 0.3, 1)
set format y '10^{%L}'
set ylabel 'max H − min H'
# Below its panel: beside the curves it would take a third of it.
set key at screen 0.56,0.22 left top Left reverse maxrows 6
plot for [i = 0:blocks(file) - 1] file index i using 1:2 with linespoints lt i + 1 title name(file, i), \
     [0.007:1] 4e-4*x**2 lt 9 dt 3 title 'h²', [0.007:1] 4e-7*x**4 lt 9 dt 4 title 'h⁴'
unset multiplot
