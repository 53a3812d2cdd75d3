import signorini

M = [[2.0, 1.0], [1.0, 2.0]]
q = [-5.0, -6.0]
result = signorini.solve(M, q)  # 0 <= z  ⊥  w = M z + q >= 0
print(result.status, result.z)
