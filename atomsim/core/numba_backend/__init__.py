"""The compiled backend: the rounds of `atomsim.core.numpy_backend`, bit for bit, several times faster; needs Numba.

Here every force is written from the receiving atom's side: an atom's subtotal is a loop over its partners in increasing
order, so atoms can be shared out to threads and nothing has to be scattered. A pair is computed twice, once from either
side; since c_i − c_k is exactly −(c_k − c_i), both sides agree.

It is imported by its row of `atomsim.core.backend_table`, and only when it is going to be used.
"""
