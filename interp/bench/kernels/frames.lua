local sin, cos, atan, sqrt = math.sin, math.cos, math.atan2 or math.atan, math.sqrt
local degree = math.pi / 180

local function matrix(f)
   local ca, sa = cos(f.a * degree), sin(f.a * degree)
   local cb, sb = cos(f.b * degree), sin(f.b * degree)
   local cc, sc = cos(f.c * degree), sin(f.c * degree)
   return {
      { ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc },
      { sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc },
      { -sb, cb * sc, cb * cc },
   }
end

local function compose(one, other)
   local left, right, m = matrix(one), matrix(other), {}
   for i = 1, 3 do
      m[i] = {}
      for k = 1, 3 do
         m[i][k] = left[i][1] * right[1][k] + left[i][2] * right[2][k] + left[i][3] * right[3][k]
      end
   end
   local function moved(i, from)
      return from + left[i][1] * other.x + left[i][2] * other.y + left[i][3] * other.z
   end
   local flat = sqrt(m[1][1] * m[1][1] + m[2][1] * m[2][1])
   local f = { x = moved(1, one.x), y = moved(2, one.y), z = moved(3, one.z) }
   f.b = atan(-m[3][1], flat) / degree
   if flat > 1e-7 then
      f.a, f.c = atan(m[2][1], m[1][1]) / degree, atan(m[3][2], m[3][3]) / degree
   else
      f.a, f.c = 0.0, atan(-m[2][3], m[2][2]) / degree
   end
   return f
end

local function work(n)
   local at = { x = 100.0, y = 0.0, z = 50.0, a = 0.0, b = 0.0, c = 0.0 }
   local step = { x = 8.0, y = 4.0, z = 0.0, a = 90.0, b = 0.0, c = 0.0 }
   local back = { x = 0.0, y = 0.0, z = -1.0, a = 0.0, b = 0.0, c = 90.0 }
   for _ = 1, n do
      at = compose(at, step)
      if at.z > 0.0 then
         at = compose(at, back)
      end
   end
   return math.floor(at.x + at.y + at.z + 0.5)
end

return work
