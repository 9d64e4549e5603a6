local function work(n)
   local i, even = 0, 0
   ::again::
   if i >= n then
      goto done
   end
   i = i + 1
   if i % 2 == 1 then
      goto again
   end
   even = even + 1
   goto again
   ::done::
   return even
end

return work
