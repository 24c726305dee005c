call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1400, 1000)
set output pictures . 'figure_5.png'
file = data . 'figure_5.dat'
set multiplot layout 2,2 margins 0.125,0.98,0.07,0.955 spacing 0.115,0.11
set xrange [0:61]
set xlabel 't' offset 0,0.6
set ylabel 'H − H(0)' offset 1,0
set format y powers
set ytics add ('0' 0)
set key top right
set title 'γ = −0.007, and β as named'
plot for [i = 0:4] file index i with lines lt i + 1 title name(file, i)
unset ylabel
set title 'β = −h E/12, and γ as named'
plot for [i = 5:9] file index i with lines lt i - 4 title name(file, i)
set ylabel 'H − H(0)' offset 1,0
set title 'the tuned pair and other methods'
plot for [i = 10:blocks(file) - 1] file index i with lines lt i - 9 title name(file, i)
set title 'the same, logarithmic'
set ylabel '|H − H(0)|'
set logscale y
set ytics autofreq
set format y '10^{%L}'
set yrange [1e-16:*]
set key off
plot for [i = 10:blocks(file) - 1] file index i using 1:(abs($2)) with lines lt i - 9
unset multiplot
