(* A member of the family is symplectic exactly as far as C J + J C^T vanishes: for every number of
   degrees of freedom, every symmetric Hessian S, every step h and every matrix C over a commutative
   ring with a half.

   The step is  Z = z + h J grad H(zbar),  zbar = (z + Z)/2 + C (Z - z).  With S the Hessian at zbar,
   differentiating it gives  A+ dZ = A- dz,

     A+ = 1 - h J S (1/2 + C),   A- = 1 + h J S (1/2 - C).

   Checked by scripts/check-theorem; used by scripts/check-certificate. *)
From mathcomp Require Import all_ssreflect all_algebra.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Import GRing.Theory.
Local Open Scope ring_scope.

(* How the terms of both products are put together. *)
Section Terms.

Variable V : zmodType.

Lemma terms_of_second_order (a b c d : V) :
  a + b + (c + d) - (a - b + (- c + d)) = (c + c) + (b + b).
Proof.
by rewrite !opprD !opprK addrACA [a + b + _]addrACA [c + d + _]addrACA !subrr add0r addr0 addrC.
Qed.

Lemma terms_of_step (j y x z y' x' z' : V) :
  j + y + (- x - z) - (j - y' + (x' - z')) = (y + y') - (x + x') - (z - z').
Proof.
rewrite !opprD !opprK addrACA [j + y + _]addrACA subrr add0r [- x - z + _]addrACA.
by rewrite addrA.
Qed.

End Terms.

Section Member.

Variables (R : comRingType) (half h : R) (m : nat).
Hypothesis halves : half + half = 1.

Variables (J S C : 'M[R]_m).
Hypothesis J_is_antisymmetric : J^T = - J.
Hypothesis S_is_symmetric : S^T = S.

Definition A_plus : 'M[R]_m := 1%:M - h *: (J *m S *m (half%:M + C)).
Definition A_minus : 'M[R]_m := 1%:M + h *: (J *m S *m (half%:M - C)).
(* What the gauge has to make zero. *)
Definition defect : 'M[R]_m := C *m J + J *m C^T.

Lemma A_plus_transposed : A_plus^T = 1%:M + h *: ((half%:M + C^T) *m S *m J).
Proof.
rewrite /A_plus linearB /= trmx1 linearZ /= !trmx_mul J_is_antisymmetric S_is_symmetric.
by rewrite linearD /= tr_scalar_mx !mulmxN scalerN opprK mulmxA.
Qed.

Lemma A_minus_transposed : A_minus^T = 1%:M - h *: ((half%:M - C^T) *m S *m J).
Proof.
rewrite /A_minus linearD /= trmx1 linearZ /= !trmx_mul J_is_antisymmetric S_is_symmetric.
by rewrite linearB /= tr_scalar_mx !mulmxN scalerN mulmxA.
Qed.

(* (1 + s X) J (1 + t Y) in powers of the scalars. *)
Lemma product_of_three (s t : R) (X Y : 'M[R]_m) :
  (1%:M + s *: X) *m J *m (1%:M + t *: Y) =
  J + t *: (J *m Y) + (s *: (X *m J) + (s * t) *: (X *m J *m Y)).
Proof.
rewrite mulmxDl mul1mx mulmxDr mulmx1 !mulmxDl.
by rewrite -!scalemxAl -!scalemxAr !scalerA addrACA.
Qed.

Lemma two_halves : half%:M + half%:M = 1%:M :> 'M[R]_m.
Proof. by rewrite -raddfD /= halves. Qed.

(* What is of first order in h cancels: both sides have J S J. *)
Lemma first_order_left :
  J *m ((half%:M + C^T) *m S *m J) + J *m ((half%:M - C^T) *m S *m J) = J *m S *m J.
Proof. by rewrite -mulmxDr -!mulmxDl addrACA two_halves subrr addr0 mul1mx mulmxA. Qed.

Lemma first_order_right :
  J *m S *m (half%:M + C) *m J + J *m S *m (half%:M - C) *m J = J *m S *m J.
Proof. by rewrite -!mulmxDl -mulmxDr addrACA two_halves subrr addr0 mulmx1. Qed.

(* The second order, between J S and S J. *)
Lemma second_order :
  (half%:M + C) *m J *m (half%:M + C^T) - (half%:M - C) *m J *m (half%:M - C^T) = defect.
Proof.
rewrite /defect !mulmxDl !mulmxDr !mulNmx !mulmxN !mul_scalar_mx !mul_mx_scalar !opprK.
by rewrite terms_of_second_order -mulmxDl -!scalerDl halves !scale1r.
Qed.

Lemma between (X Y X' Y' : 'M[R]_m) :
  J *m S *m X *m J *m (Y *m S *m J) - J *m S *m X' *m J *m (Y' *m S *m J) =
  J *m S *m (X *m J *m Y - X' *m J *m Y') *m S *m J.
Proof. by rewrite mulmxBr !mulmxBl !mulmxA. Qed.

(* The theorem. *)
Theorem step_defect :
  A_plus *m J *m A_plus^T - A_minus *m J *m A_minus^T =
  - (h ^+ 2) *: (J *m S *m defect *m S *m J).
Proof.
rewrite A_plus_transposed A_minus_transposed /A_plus /A_minus -!scaleNr !product_of_three.
rewrite mulNr mulrN -expr2 !scaleNr terms_of_step -!scalerDr -scalerBr.
by rewrite first_order_left first_order_right subrr scaler0 sub0r -scalerBr between second_order.
Qed.

(* What a certificate shows of C makes the step symplectic. *)
Corollary step_is_symplectic :
  defect = 0 -> A_plus *m J *m A_plus^T = A_minus *m J *m A_minus^T.
Proof.
move=> gauge; apply/eqP; rewrite -subr_eq0 step_defect gauge.
by rewrite mulmx0 !mul0mx scaler0.
Qed.

End Member.

(* The same of the step's derivative M = A+^-1 A-, where the step has one. *)
Section Derivative.

Variables (R : comUnitRingType) (half h : R) (m : nat).
Hypothesis halves : half + half = 1.

Variables (J S C : 'M[R]_m).
Hypothesis J_is_antisymmetric : J^T = - J.
Hypothesis S_is_symmetric : S^T = S.
Hypothesis gauge : defect J C = 0.
Hypothesis solvable : A_plus half h J S C \in unitmx.

Definition M : 'M[R]_m := invmx (A_plus half h J S C) *m A_minus half h J S C.

Theorem derivative_is_symplectic : M *m J *m M^T = J.
Proof.
have equal := step_is_symplectic h halves J_is_antisymmetric S_is_symmetric gauge.
rewrite /M trmx_mul !mulmxA -[_ *m A_minus _ _ _ _ _ *m J]mulmxA.
rewrite -[_ *m (A_minus half h J S C *m J) *m _]mulmxA -equal trmx_inv.
by rewrite !mulmxA mulVmx // mul1mx mulmxK // unitmx_tr.
Qed.

End Derivative.

(* J of n degrees of freedom, z = (q, p), is such a J. *)
Section Canonical.

Variables (R : comRingType) (n : nat).

Definition canonical : 'M[R]_(n + n) := block_mx 0 1%:M (- 1%:M) 0.

Lemma canonical_is_antisymmetric : canonical^T = - canonical.
Proof. by rewrite /canonical tr_block_mx !trmx0 linearN /= trmx1 opp_block_mx !oppr0 opprK. Qed.

Corollary canonical_step_defect (half h : R) (S C : 'M[R]_(n + n)) :
  half + half = 1 -> S^T = S ->
  let plus := A_plus half h canonical S C in
  let minus := A_minus half h canonical S C in
  plus *m canonical *m plus^T - minus *m canonical *m minus^T =
  - (h ^+ 2) *: (canonical *m S *m (C *m canonical + canonical *m C^T) *m S *m canonical).
Proof. by move=> halves symmetric; apply: step_defect canonical_is_antisymmetric symmetric. Qed.

End Canonical.
