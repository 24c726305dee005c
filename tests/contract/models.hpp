// What is smooth for thousands of steps and then steep: walls that are met seldom.  A rule that has
// learnt its contraction where nothing happens is wrong there.
#pragma once

#include <array>
#include <string>

namespace hamgen::contract {

struct SteepModel {
  const char* name;
  const char* text;      // after "system NAME"
  bool cancels = false;  // see has_cancelling_forces
};

inline constexpr std::array kSteepModels = {
    // The force grows by a factor of 1.6 a step, and in the second scene of 2.7.
    SteepModel{"box", R"(coordinate q
momentum p
H = p^2/2 + exp(-50*(q + 1)) + exp(50*(q - 1))
scene soft { q = 0; p = -1; h = 0.01; steps = 3000 }
scene fast { q = 0; p = -1; h = 0.02; steps = 3000 }
)"},
    // Walls so hard that a prediction may end deep in one of them.
    SteepModel{"hard_box", R"(coordinate q
momentum p
H = p^2/2 + exp(-500*(q + 1)) + exp(500*(q - 1))
scene fine { q = 0; p = -1; h = 0.002; steps = 3000 }
scene coarse { q = 0; p = -1; h = 0.01; steps = 2400 }
)"},
    // A wall beside a motion that never stops: the box's is hidden behind the other unknown.
    SteepModel{"wobble", R"(coordinate q, x
momentum p, u
H = p^2/2 + exp(-50*(q + 1)) + exp(50*(q - 1)) + u^2/2 + x^2/2 + x^4/4 + x^2*q/100
scene slow { q = 0; p = -0.3; x = 1; h = 0.01; steps = 3000 }
scene coarse { q = 0; p = -0.3; x = 1; h = 0.05; steps = 3000 }
)"},
    SteepModel{"morse_approach", R"(coordinate q
momentum p
H = p^2/2 + (1 - exp(-q))^2
scene far { q = 30; p = -1.5; h = 0.05; steps = 1500 }
)"},
    SteepModel{"lennard_jones", R"(coordinate x, y
momentum u, v
H = (u^2 + v^2)/2 + 4*((x^2 + y^2)^(-6) - (x^2 + y^2)^(-3))
scene fast { x = -60; u = 8; y = 0.3; h = 0.01; steps = 1500 }
scene slow { x = -6; u = 1; y = 0.3; h = 0.01; steps = 1500 }
scene head_on { x = -60; u = 8; h = 0.01; steps = 1500 }
)"},
    // Steps so long that a fixed point contracts by 0.9, with either sign, and Newton's start is
    // far.
    SteepModel{"swing", R"(coordinate q
momentum p
H = p^2/2 - cos(q)
scene below { q = 0.5; h = 1.9; steps = 1000 }
scene above { q = 3.1; h = 1.9; steps = 1000 }
scene round { q = 3; p = 1; h = 1.9; steps = 1000 }
)"},
    // Sums that stay loops: beads between two walls that meet one another by exponentials.
    SteepModel{"hard_beads", R"(size N = 32
coordinate q[1..N] with q[0] = 0, q[N+1] = 0
momentum p[1..N]
H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, exp(40*(q[i] - q[i+1] - 1)))
scene shot { p[1] = 2; p[16] = -3; h = 0.01; steps = 300 }
)"},
    // The same in a frame that turns: momenta are no function of the coordinates of a stage.
    SteepModel{"turning_beads", R"(size N = 12
coordinate x[1..N] with x[0] = 0, x[N+1] = 0
coordinate y[1..N]
momentum u[1..N], v[1..N]
parameter w = 1/2
H = sum(i = 1..N, (u[i]^2 + v[i]^2)/2 - w*(x[i]*v[i] - y[i]*u[i]) + y[i]^2/2) + sum(i = 0..N, exp(40*(x[i] - x[i+1] - 1)))
scene shot { u[1] = 2; u[6] = -3; v[i] = 1/10; h = 0.01; steps = 300 }
scene coarse { u[1] = 2; u[6] = -3; v[i] = 1/10; h = 0.03; steps = 100 }
)"},
    // Velocities that hang on the momenta of neighbours, and one of them on the place, too.
    SteepModel{"linked_beads", R"(size N = 9
coordinate q[1..N] with q[0] = 0, q[N+1] = 0
momentum p[1..N]
H = sum(i = 1..N, p[i]^2/(2 + q[i]^2)) + sum(i = 1..N-1, p[i]*p[i+1]/5) + sum(i = 0..N, exp(30*(q[i] - q[i+1] - 1)))
scene shot { p[1] = 2; p[5] = -3; h = 0.01; steps = 300 }
scene coarse { p[1] = 2; p[5] = -3; h = 0.03; steps = 100 }
)"},
    // A long wave on a chain: the increments that are seen contract faster than what rounding has
    // left in the short waves.
    SteepModel{"long_wave", R"(size N = 64
coordinate q[1..N] with q[0] = 0, q[N+1] = 0
momentum p[1..N]
H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^3/12)
scene swing { q[i] = sin(pi*i/(N+1))/10; h = 0.7; steps = 100 }
)"},
    // Oscillators alone, of which one is much smaller than the others and contracts more slowly.
    SteepModel{"one_small", R"(size N = 31
coordinate q[1..N]
momentum p[1..N]
parameter a[1..N] = 1
H = sum(i = 1..N, p[i]^2/2) + sum(i = 1..N, a[i]*(q[i]^2/2 + 1e-12*q[i]^4/4))
scene slow { a[i] = 4e-4; a[1] = 0.16; q[i] = 1000; q[1] = 1e-4; h = 1; steps = 120 }
scene still { a[i] = 4e-6; a[1] = 0.16; q[i] = 1000; q[1] = 1e-4; h = 1; steps = 120 }
)"},
    // A motion along x, from which y moves hardly away.
    SteepModel{"one_slow", R"(coordinate x, y
momentum u, v
H = (u^2 + v^2)/2 + x^4/4 + 20*(1 - cos(y)) + x^2*y^2/10
scene small { x = 1; y = 1e-8; u = 0.3; v = 1e-8; h = 0.1; steps = 200 }
)"},
    // Forces that are what terms of another size leave: see Note [forces that cancel] in
    // mechanics/cancelling_forces.hpp.
    SteepModel{"near_rest", R"(coordinate q
momentum p
H = p^2/2 + exp(q) - q
scene small { q = 1e-9; h = 0.1; steps = 300 }
scene tiny { q = 1e-14; h = 0.1; steps = 100 }
)",
               true},
    SteepModel{"two_near_rest", R"(coordinate x, y
momentum u, v
parameter k = 3
H = u^2/2 + 5*v^2 + k*(1 - exp(-x))^2 + exp(30*(x - y)) - 30*(x - y) + y^2
scene small { x = 1e-9; v = 1e-7; h = 0.02; steps = 150 }
)",
               true},
    // And beside such a force one whose terms all vanish.
    SteepModel{"beside_near_rest", R"(coordinate x, y
momentum u, v
H = u^2/2 + v^2/2 + exp(x) - x + 5*y^2 + y^4
scene small { x = 1e-9; u = 1e-9; y = 1e-12; v = 1e-12; h = 0.2; steps = 100 }
)",
               true},
    // And where the terms are gone, the state being far from that equilibrium.
    SteepModel{"far_from_rest", R"(coordinate x, y, z
momentum u, v, w
H = (u^2 + v^2 + w^2)/2 + exp(x - y) + exp(y - z) + y^2/2 + y^4/4
scene far { x = -60; z = 60; y = 1e-12; v = 3e-13; h = 0.1; steps = 20 }
)"},
    SteepModel{"array_beside_near_rest", R"(size N = 24
coordinate q[1..N] periodic
coordinate x[1..N]
momentum p[1..N]
momentum u[1..N]
H = sum(i = 1..N, p[i]^2/2 + exp(q[i] - q[i+1])) + sum(i = 1..N, u[i]^2/2 + 5*x[i]^2 + x[i]^4)
scene loud { q[i] = 1e-3*sin(i^2); p[i] = 1e-3*cos(3*i^2); x[i] = 1e-12*sin(i^2); u[i] = 1e-12*cos(3*i^2); h = 0.2; steps = 30 }
)",
               true},
    SteepModel{"ring_near_rest", R"(size N = 32
coordinate q[1..N] periodic
momentum p[1..N]
H = sum(i = 1..N, p[i]^2/2 + exp(q[i] - q[i+1]))
scene waves { q[i] = 1e-9*sin(i^2); p[i] = 1e-9*cos(3*i^2); h = 0.05; steps = 60 }
scene tiny { q[i] = 1e-13*sin(i^2); p[i] = 1e-13*cos(3*i^2); h = 0.2; steps = 30 }
)",
               true},
    // What all elements have to do with: t, and a wave.
    SteepModel{"driven_ring", R"(size N = 24
coordinate q[1..N] periodic
momentum p[1..N]
time t
parameter m[1..N] = 1
H = sum(i = 1..N, p[i]^2/(2*m[i]) + (1 + 0.4*cos(2*t))*(q[i+1] - q[i])^2/2 + q[i]^4/4 - sin(t)*q[i])
scene even { q[i] = sin(i^2); h = 0.1; steps = 100 }
scene heavy { m[1] = 9; m[7] = 1/9; q[i] = sin(i^2); h = 0.1; steps = 100 }
)"},
    SteepModel{"wave_and_particles", R"(size N = 24
coordinate x[1..N], f
momentum v[1..N], J
H = sum(i = 1..N, v[i]^2/2) + J/2 + 0.2*sqrt(J)*sum(i = 1..N, cos(x[i] - f))
scene beam { x[i] = 0.26*i; v[i] = 0.5 + 0.1*sin(i^2); J = 2; h = 0.2; steps = 100 }
)"},
    // A light bead that a kick brings to rest: its momentum is what cancels, and moves it far.
    SteepModel{"light_bead", R"(size N = 26
coordinate q[1..N] with q[0] = 0, q[N+1] = 0
momentum p[1..N]
time t
parameter m[1..N] = 1
H = sum(i = 1..N, p[i]^2/(2*m[i])) + sum(i = 0..N, (1 + 0.9*cos(30*t))*(q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4) - 50*sin(40*t)*q[3]
scene once { q[i] = 3*sin(i); m[3] = 1/1000; t = 0.2; h = 0.3; steps = 1 }
scene on { q[i] = 3*sin(i); m[3] = 1/10; t = 0.2; h = 0.1; steps = 60 }
)"},
    // Beads in a row, of which the first one is thrown at the others.
    SteepModel{"row", R"(coordinate q1, q2, q3, q4
momentum p1, p2, p3, p4
H = (p1^2 + p2^2 + p3^2 + p4^2)/2 + exp(40*(q1-q2-1)) + exp(40*(q2-q3-1)) + exp(40*(q3-q4-1)) + exp(40*(-q1-1)) + exp(40*(q4-4))
scene thrown { p1 = 2; h = 0.01; steps = 300 }
scene two { p1 = 2; p3 = -3; h = 0.01; steps = 300 }
)"},
    // Walls of a coordinate that is written in another unit than the one beside it.
    SteepModel{"unlike_units", R"(coordinate x, y
momentum u, v
parameter M = 1
H = u^2/2 + x^2/2 + v^2/(2*M) + exp(20*(y*sqrt(M) - 1)) + exp(20*(-y*sqrt(M) - 1)) + x^2*y*sqrt(M)/10
scene alike { M = 1; x = 1; v = 0.7; h = 0.03; steps = 20000 }
scene small { M = 1e6; x = 1; v = 700; h = 0.03; steps = 20000 }
scene tiny { M = 1e10; x = 1; v = 70000; h = 0.03; steps = 20000 }
)"},
    // An orbit beside what is written in a larger unit, and begins at zero as one of its
    // coordinates.
    SteepModel{"beside_large", R"(coordinate x, y, w
momentum px, py, pw
parameter s = 1
H = (px^2 + py^2)/2 - 1/sqrt(x^2 + y^2) + (pw/s)^2/2 + (w*s)^4/4 + w*s*x/10
scene alike { s = 1; x = 0.1; py = 4.3; pw = 0.5; h = 0.001; steps = 20000 }
scene large { s = 1e-6; x = 0.1; py = 4.3; pw = 5e-7; h = 0.001; steps = 20000 }
)"},
    // A pendulum that has gone round very often, coupled to one that swings.
    SteepModel{"wound", R"(coordinate a, b
momentum p, q
H = p^2/2 + q^2/2 - cos(a) - cos(b) - cos(a - b)/2
scene often { a = 1000000; p = 3; b = 1; h = 0.02; steps = 20000 }
scene longer { a = 1000000; p = 3; b = 1; h = 0.03; steps = 20000 }
)"},
    // Walls of y that are met slowly, beside an x that moves freely and is hardly coupled.
    SteepModel{"free_wall", R"(coordinate x, y
momentum u, v
parameter k = 1e4
H = (u^2 + v^2)/2 + (exp(k*(y - 1)) + exp(-k*(y + 1)))/k + 1e-9*cos(x)*y
scene slow { u = -1; y = 0.99; v = 0.003; h = 0.01; steps = 3000 }
scene harder { k = 1e5; u = 1000; y = 0.999; v = 0.0003; h = 0.01; steps = 3000 }
)"},
    // A hard wall of y that is met once, beside an x that goes to and fro between softer ones.
    SteepModel{"two_walls", R"(coordinate x, y
momentum u, v
parameter k = 1e5
H = (u^2 + v^2)/2 + (exp(k*(y - 1)) + exp(-k*(y + 1)))/k + exp(20*(x - 1)) + exp(-20*(x + 1)) + 1e-6*x*y
scene once { u = 3; y = 0.99; v = 0.001; h = 0.01; steps = 3000 }
)"},
    // Hard walls of q beside an oscillation of 1e-6.
    SteepModel{"small_oscillator", R"(coordinate q, y
momentum p, v
parameter w = 10
parameter k = 1000
H = p^2/2 + (exp(k*(q - 1)) + exp(-k*(q + 1)))/10 + v^2/2 + w^2*y^2/2 + 1e-9*cos(q - y)
scene wall { q = 0.9; p = 0.1; y = 1e-6; h = 0.01; steps = 3000 }
)"},
    // x falls from 1e4 to 1 in 29 steps: its size lags behind.
    SteepModel{"saddle", R"(coordinate x, y
momentum u, v
H = (u^2 + v^2)/2 - x^2/2 + y^2/2 + 1/x^2 + y^4/40 + 0.01*y^2/(1 + x^2)
scene fall { x = 1e4; u = -1e4 - 0.0001; y = 0.5; h = 0.3; steps = 100 }
)"},
    // y is less than a 2^-40th of x.
    SteepModel{"beside_huge", R"(coordinate x, y
momentum u, v
H = (u^2 + v^2)/2 + y^2/2 + y^4/4 + y^2/(1 + x^2)
scene away { x = 1e14; u = 1e13; y = 5; h = 0.3; steps = 3000 }
)"},
    // Something heavy at rest, and something light that meets it softly.
    SteepModel{"heavy", R"(coordinate x, y
momentum u, v
parameter M = 1e6
parameter A = 1e-5
H = u^2/2 + v^2/(2*M) + A*exp(-(10*(x - y))^2)
scene million { x = -12; y = 1; u = 1; h = 0.1; steps = 200 }
scene billion { M = 1e9; x = -12; y = 1; u = 1; h = 0.1; steps = 200 }
scene fine { M = 1e9; A = 1e-4; x = -12; y = 1; u = 1; h = 0.03; steps = 666 }
)"},
    // A force that grows by up to e^3 in a step, seen by a quiet y.
    SteepModel{"grows", R"(coordinate x, y
momentum u, v
parameter k = 1e4
H = (u^2 + v^2)/2 + exp(k*(y - 1))/k^2 + 1e-9*cos(x)*y
scene often { k = 1e2; u = 1; y = 1 - 0.756875; v = 2.5; h = 0.01; steps = 60 }
scene quietly { u = 1; y = 1 - 0.00761875; v = 0.025; h = 0.01; steps = 60 }
scene more { k = 1e3; u = 1; y = 1 - 0.09105; v = 0.3; h = 0.01; steps = 60 }
)"},
    // The same where it is alone: what is lost in the rounding of y may not be in that of v.
    SteepModel{"grows_alone", R"(coordinate y
momentum v
parameter k = 1e4
H = v^2/2 + exp(k*(y - 1))/k^2
scene often { y = 1 - 0.00453; v = 0.015; h = 0.01; steps = 60 }
scene more { k = 1e5; y = 1 - 0.000607; v = 0.002; h = 0.01; steps = 60 }
)"},
    // Ripples that a step hardly resolves.
    SteepModel{"ripple", R"(coordinate x, y
momentum u, v
parameter A = 5e-5
parameter K = 20
H = (u^2 + v^2)/2 + A*cos(K*y) + 1e-12*y*cos(x)
scene beside { x = 1; u = 1; y = 300; v = 1; h = 0.1; steps = 3000 }
scene loud { x = 1; u = 1000; y = 0.1; v = 1; h = 0.1; steps = 3000 }
)"},
    // Two in a trap whose distance is at rest at a saddle, and grows from 1e-10 to 1.
    SteepModel{"together", R"(coordinate x, y, z, w
momentum u, v, b, g
parameter c = 18
parameter l = 1
parameter k = 8
H = (u^2 + v^2 + b^2 + g^2)/2 + k*(x + y)^2 - c^2*(y - x)^2/4 + c^2*(y - x)^3/(6*l) + c^2*(y - x)^4/(8*l^2) + 1e-12*(z*w^2 + x*w^2 + x*z^2)
scene slow { x = -0.3; y = -0.3 + 1e-10; u = 0.26; v = 0.26; z = 1; w = -0.3; b = 1; g = 3; h = 0.05; steps = 60 }
scene fast { c = 19; x = -0.17; y = -0.17 + 1e-10; u = 1.6; v = 1.6; z = 1; w = -0.3; b = 1; g = 3; h = 0.05; steps = 60 }
scene short { c = 7; l = 1e-3; x = -0.45; y = -0.45 + 1e-10; u = -0.06; v = -0.06; z = 1; w = -0.3; b = 1; g = 3; h = 0.05; steps = 110 }
scene stiff { k = 200; c = 10; l = 0.01; x = -0.5; y = -0.5 + 1e-10; u = 5; v = 5; z = 1; w = -0.3; b = 1; g = 3; h = 0.05; steps = 80 }
)"},
    // A pair that goes in a step as far as it is long, or up to fifty times as far, and swings
    // widely or hardly at all.
    SteepModel{"in_flight", R"(coordinate x, y
momentum u, v
parameter l = 1
parameter D = 200
H = (u^2 + v^2)/2 + D*(1 - exp(-(y - x - l)/l))^2
scene close { x = 0; u = 20; y = 1.001; v = 20; h = 0.05; steps = 100 }
scene far { l = 0.1; D = 2; x = 0; u = 20; y = 0.1001; v = 20; h = 0.05; steps = 100 }
scene quiet { l = 0.2; D = 1; x = 5; u = 20; y = 5.20003; v = 20; h = 0.05; steps = 60 }
scene short { l = 0.02; D = 0.02; x = -30; u = 20; y = 0.02003 - 30; v = 20; h = 0.05; steps = 60 }
)"},
    // A pair in flight beside what begins at rest at zero, and has no size yet.
    SteepModel{"in_flight_beside", R"(coordinate x, y, z
momentum u, v, r
parameter k = 294
parameter e = 1e-8
H = (u^2 + v^2 + r^2)/2 + z^2/40 + k*(y - x - 1)^2/2*(1 + (y - x - 1)/3) + e*z*(y - x)
scene still { k = 293.65731065706564; e = 8.561521460769279e-9; x = 0; y = 1.0000008672835774; u = 3.072556439445612; v = 3.072556439445612; h = 0.05; steps = 80 }
)"},
    // Next to an equilibrium of y all its increments are of the size of rounding, and the fixed
    // point of gauss-4 hardly contracts.
    SteepModel{"next_to_rounding", R"(coordinate x, y
momentum u, v
H = u^2/2 + v^2/2 + x^2/2 + 9998*(y-1)^2/2 + x^4/100 + (y-1)^4/1000
scene still { x = 1; y = 1 + 1/10000000000000; h = 0.0346; steps = 20 }
)"}};

}  // namespace hamgen::contract
