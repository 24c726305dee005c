call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1400, 500)
set output pictures . 'time_reversal.png'
file = data . 'time_reversal.dat'
set lmargin 12
set xlabel 't'
set ylabel 'H − H(0)'
set format y '%.0t·10^{%T}'
set ytics add ('0' 0)
set key top left Left reverse
set yrange [-0.0035:0.0035]
plot file index 0 with lines lt 1 title 'α = 0.3', file index 1 with lines lt 1 notitle, \
     file index 2 with lines lt 2 dt (8,4) title 'α = 0.7', \
     file index 3 with lines lt 2 dt (8,4) notitle
