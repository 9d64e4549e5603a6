local function work(n)
   local points = {}
   for i = 1, 100 do
      points[i] = { x = i + 0.0, y = 100.0 - i, a = 0.5, b = -0.25 }
   end
   for _ = 1, n do
      for i = 1, 100 do
         local point = points[i]
         point.x = point.x + point.a
         point.y = point.y + point.b
         if point.x > 100.0 then
            point.a = -0.5
         end
         if point.y < 0.0 then
            point.b = 0.25
         end
      end
   end
   local sum = 0.0
   for i = 1, 100 do
      sum = sum + points[i].x + points[i].y
   end
   return math.floor(sum + 0.5)
end

return work
