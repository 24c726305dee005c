call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1400, 620)
set output pictures . 'figure_3.png'
file = data . 'figure_3.dat'
set multiplot layout 1,2 margins 0.07,0.98,0.13,0.92 spacing 0.07
set xlabel 'q'
set ylabel 'p' offset 1.5,0
set key off
set xrange [-3.3:3.3]
set yrange [-0.46:0.46]
do for [k = 0:1] {
  set title k == 0 ? '(α, β, γ) = (1/2, 0, 0)' : '(α, β, γ) = (0.1, 0.3, 0.3)'
  plot for [i = 0:3] file index 8 + i with lines lt 9 lw 1.2, \
       for [i = 0:3] file index 4*k + i with points lt i + 1 pt 7 ps 0.35
}
unset multiplot
